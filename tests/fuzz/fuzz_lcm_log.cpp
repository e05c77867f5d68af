#include "drivers/lcm_log_reader.hpp"
#include "hal/expect.hpp"
#include "tests/fuzz/fuzz_target.hpp"

namespace {

using namespace hitchview;

constexpr drivers::LcmLogReaderOptions kOptions{.max_data_bytes = 1 << 16};

/// Events follow each other, and together with what was skipped they are the whole file.
void ReadAll(std::span<const std::uint8_t> log) {
    drivers::LcmLogReader reader(log, kOptions);
    std::uint64_t read_bytes = 0;
    std::uint64_t end = 0;
    while (const auto event = reader.Next()) {
        HV_EXPECT(event.value().position_bytes >= end);
        HV_EXPECT(!event.value().channel.empty());
        end = reader.position_bytes();
        const auto data = event.value().data;
        HV_EXPECT(data.size() <= static_cast<std::size_t>(kOptions.max_data_bytes));
        HV_EXPECT(data.data() + data.size() == log.data() + end);
        read_bytes += end - event.value().position_bytes;
    }
    HV_EXPECT(read_bytes + reader.damage().skipped_bytes == log.size());
    HV_EXPECT(reader.damage().torn_bytes <= reader.damage().skipped_bytes);
}

/// The first event behind is of that time or later.
void Seek(std::span<const std::uint8_t> log, std::int64_t utime_us) {
    drivers::LcmLogReader reader(log, kOptions);
    if (!reader.SeekToTime(utime_us)) return;
    const auto event = reader.Next();
    HV_EXPECT(event.ok() && event.value().utime_us >= utime_us);
}

}  // namespace

int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
    ReadAll({data, size});
    Seek({data, size}, 1'700'000'001'000'000);
    return 0;
}
