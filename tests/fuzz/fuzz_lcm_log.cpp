#include "tests/fuzz/fuzz_lcm_log.hpp"

#include <sys/mman.h>
#include <unistd.h>

#include <string>
#include <vector>

#include "drivers/lcm_logged_health.hpp"
#include "drivers/lcm_log_messages.hpp"
#include "drivers/lcm_log_picture.hpp"
#include "drivers/lcm_log_reader.hpp"
#include "drivers/lcm_logged_overlay.hpp"
#include "hal/expect.hpp"

namespace {

using namespace hitchview;

/// Bytes as a file that is in no folder.
class MemoryFile {
 public:
    explicit MemoryFile(std::span<const std::uint8_t> bytes)
        : descriptor_(memfd_create("log", MFD_CLOEXEC)) {
        HV_EXPECT(write(descriptor_, bytes.data(), bytes.size()) == std::ssize(bytes));
    }
    ~MemoryFile() { close(descriptor_); }
    MemoryFile(const MemoryFile&) = delete;
    MemoryFile& operator=(const MemoryFile&) = delete;

    [[nodiscard]] std::string path() const {
        return "/proc/self/fd/" + std::to_string(descriptor_);
    }

 private:
    int descriptor_;
};

/// A message may claim any size; those of a recording's cameras are known beforehand.
void Decode(const drivers::LoggedImage& image) {
    constexpr std::size_t kLargestFrame = 1 << 20;
    const auto kind = drivers::PictureKindOf(image);
    if (!kind || hal::FrameBytes(kind->format) > kLargestFrame) return;
    std::vector<std::uint8_t> frame(hal::FrameBytes(kind->format));
    (void)drivers::LcmLogPictureDecoder(*kind).Decode(image, frame);
}

void ParseAsEverything(std::span<const std::uint8_t> message) {
    if (const auto image = drivers::ParseLoggedImage(message)) Decode(image.value());
    (void)drivers::ParseLoggedCanFrame(message);
    (void)drivers::ParseLoggedHitchAngle(message);
    (void)drivers::ParseLoggedStatus(message);
    (void)drivers::ParseLoggedClock(message);
    (void)drivers::ParseLoggedEvent(message);
    (void)drivers::ParseLoggedRig(message);
    (void)drivers::ParseLoggedHealth(message);
    (void)drivers::ParseLoggedOverlay(message);
}

/// Events follow each other, and together with what was skipped they are the whole file.
void ReadAll(drivers::LcmLogReader& reader) {
    std::uint64_t read_bytes = 0;
    std::uint64_t end = 0;
    while (const auto event = reader.Next()) {
        HV_EXPECT(event.value().position_bytes >= end);
        HV_EXPECT(!event.value().channel.empty());
        end = reader.position_bytes();
        read_bytes += end - event.value().position_bytes;
        ParseAsEverything(event.value().data);
    }
    HV_EXPECT(read_bytes + reader.damage().skipped_bytes == reader.size_bytes());
}

}  // namespace

int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
    const MemoryFile file({data, size});
    auto reader = drivers::LcmLogReader::Open(file.path(), {.max_data_bytes = 1 << 16});
    HV_EXPECT(reader.ok());
    ReadAll(**reader);
    const auto found = (*reader)->SeekToTime(1'700'000'001'000'000);
    if (found) HV_EXPECT((*reader)->Next().ok());
    ParseAsEverything({data, size});
    return 0;
}
