#include <gtest/gtest.h>
#include <lcm/lcm.h>
#include <sys/resource.h>

#include <array>
#include <cerrno>
#include <csignal>

#include "drivers/lcm_log_reader.hpp"
#include "drivers/lcm_log_writer.hpp"
#include "tests/support/heap_calls.hpp"
#include "tests/support/random_log.hpp"
#include "tests/support/temporary_folder.hpp"

namespace hitchview::drivers {
namespace {

using tests::OwnedEvent;
using tests::RandomLog;

/// No file of this process may grow beyond a size, as on a full disk, while it lives.
class SmallDisk {
 public:
    explicit SmallDisk(rlim_t bytes) {
        std::signal(SIGXFSZ, SIG_IGN);
        getrlimit(RLIMIT_FSIZE, &before_);
        const rlimit limit{bytes, before_.rlim_max};
        setrlimit(RLIMIT_FSIZE, &limit);
    }
    ~SmallDisk() { setrlimit(RLIMIT_FSIZE, &before_); }
    SmallDisk(const SmallDisk&) = delete;
    SmallDisk& operator=(const SmallDisk&) = delete;

 private:
    rlimit before_{};
};

TEST(LcmLogWriterTest, LiblcmReadsWhatItWrites) {
    const tests::TemporaryFolder folder;
    const RandomLog log(1, 100);
    const std::string file = folder / "log.lcm";
    auto writer = LcmLogWriter::Create(file);
    for (const OwnedEvent& event : log.events)
        ASSERT_TRUE((*writer)->Append(event.utime_us, event.channel, event.data).ok());
    ASSERT_TRUE((*writer)->Sync().ok());
    EXPECT_EQ((*writer)->bytes(), log.bytes.size());

    lcm_eventlog_t* const stock = lcm_eventlog_create(file.c_str(), "r");
    for (const OwnedEvent& event : log.events) {
        lcm_eventlog_event_t* const read = lcm_eventlog_read_next_event(stock);
        ASSERT_NE(read, nullptr);
        EXPECT_EQ(read->timestamp, event.utime_us);
        EXPECT_EQ(std::string(read->channel), event.channel);
        EXPECT_EQ(read->datalen, std::ssize(event.data));
        EXPECT_TRUE(std::equal(event.data.begin(), event.data.end(),
                               static_cast<const std::uint8_t*>(read->data)));
        lcm_eventlog_free_event(read);
    }
    EXPECT_EQ(lcm_eventlog_read_next_event(stock), nullptr);
    lcm_eventlog_destroy(stock);
}

TEST(LcmLogWriterTest, AFullDiskLeavesWholeEventsAndWritingGoesOnWhenThereIsRoom) {
    const tests::TemporaryFolder folder;
    const std::string file = folder / "log.lcm";
    auto writer = LcmLogWriter::Create(file);
    const std::array<std::uint8_t, 1000> data{};
    {
        const SmallDisk disk(2500);
        EXPECT_TRUE((*writer)->Append(1, "CHANNEL", data).ok());
        EXPECT_TRUE((*writer)->Append(2, "CHANNEL", data).ok());
        errno = 0;
        EXPECT_FALSE((*writer)->Append(3, "CHANNEL", data).ok());
        EXPECT_EQ(errno, EFBIG);
        EXPECT_EQ(std::filesystem::file_size(file), (*writer)->bytes());
    }
    EXPECT_TRUE((*writer)->Append(4, "CHANNEL", data).ok());

    auto reader = LcmLogReader::Open(file);
    for (const std::int64_t utime_us : {1, 2, 4})
        EXPECT_EQ((*reader)->Next().value().utime_us, utime_us);
    EXPECT_FALSE((*reader)->Next().ok());
    EXPECT_EQ((*reader)->damage().skipped_bytes, 0U);
}

TEST(LcmLogWriterTest, AppendTakesNoMemory) {
    const tests::TemporaryFolder folder;
    auto writer = LcmLogWriter::Create(folder / "log.lcm");
    const std::array<std::uint8_t, 1000> data{};
    const std::uint64_t before = tests::HeapCallsOfThisThread();
    for (int i = 0; i < 100; ++i) (void)(*writer)->Append(i, "CHANNEL", data);
    if (!tests::kHeapCallsAreCounted) GTEST_SKIP();
    EXPECT_EQ(tests::HeapCallsOfThisThread(), before);
}

TEST(LcmLogWriterTest, SaysWhichFileCannotBeWritten) {
    const auto writer = LcmLogWriter::Create("/nowhere/log.lcm");
    ASSERT_FALSE(writer.ok());
    EXPECT_NE(writer.error().find("/nowhere/log.lcm: cannot be written"), std::string::npos);
}

}  // namespace
}  // namespace hitchview::drivers
