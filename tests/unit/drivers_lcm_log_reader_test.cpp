#include <gtest/gtest.h>
#include <lcm/lcm.h>

#include <algorithm>
#include <set>

#include "drivers/lcm_log_reader.hpp"
#include "tests/support/heap_calls.hpp"
#include "tests/support/random_log.hpp"
#include "tests/support/temporary_folder.hpp"

namespace hitchview::drivers {
namespace {

using tests::LogBytes;
using tests::OwnedEvent;
using tests::RandomLog;

struct ReadLog {
    std::vector<OwnedEvent> events;
    LcmLogDamage damage;
};

ReadLog ReadAll(LcmLogReader& reader) {
    ReadLog read;
    auto event = reader.Next();
    for (; event; event = reader.Next()) read.events.emplace_back(event.value());
    EXPECT_EQ(event.error(), hal::Error::kEndOfStream);
    read.damage = reader.damage();
    return read;
}

ReadLog ReadAll(const std::string& file, const LcmLogReaderOptions& options = {}) {
    auto reader = LcmLogReader::Open(file, options);
    HV_EXPECT(reader.ok());
    return ReadAll(**reader);
}

class LcmLogReaderTest : public testing::Test {
 protected:
    ReadLog ReadAll(const LogBytes& bytes, const LcmLogReaderOptions& options = {}) {
        tests::WriteBytes(file_, bytes);
        LcmLogReader of_memory(bytes, options);
        ReadLog read = drivers::ReadAll(file_, options);
        EXPECT_EQ(drivers::ReadAll(of_memory).events, read.events);
        EXPECT_EQ(of_memory.damage().skipped_bytes, read.damage.skipped_bytes);
        return read;
    }

    tests::TemporaryFolder folder_;
    std::string file_ = folder_ / "log.lcm";
};

TEST_F(LcmLogReaderTest, ReadsEveryEventOfAWholeLog) {
    const RandomLog log(1, 500);
    const ReadLog read = ReadAll(log.bytes);
    EXPECT_EQ(read.events, log.events);
    EXPECT_EQ(read.damage.skipped_bytes, 0U);
}

TEST_F(LcmLogReaderTest, ReadsWhatLiblcmWrites) {
    const RandomLog log(2, 100);
    lcm_eventlog_t* const stock = lcm_eventlog_create(file_.c_str(), "w");
    for (const OwnedEvent& event : log.events) {
        OwnedEvent copy = event;
        lcm_eventlog_event_t written{.eventnum = 0,
                                     .timestamp = event.utime_us,
                                     .channellen = static_cast<std::int32_t>(event.channel.size()),
                                     .datalen = static_cast<std::int32_t>(event.data.size()),
                                     .channel = copy.channel.data(),
                                     .data = copy.data.data()};
        ASSERT_EQ(lcm_eventlog_write_event(stock, &written), 0);
    }
    lcm_eventlog_destroy(stock);
    EXPECT_EQ(drivers::ReadAll(file_).events, log.events);
}

TEST_F(LcmLogReaderTest, ALogCutAnywhereKeepsEveryEventBeforeTheCut) {
    RandomLog log(3, 200);
    for (int i = 0; i < 1000; ++i) {
        const auto cut = static_cast<std::size_t>(log.Up(static_cast<int>(log.bytes.size()) - 1));
        const ReadLog read = ReadAll(LogBytes(log.bytes.begin(), log.bytes.begin() + cut));
        const auto whole = std::ranges::count_if(
            log.events, [&](const OwnedEvent& event) { return event.EndBytes() <= cut; });
        ASSERT_EQ(read.events, std::vector(log.events.begin(), log.events.begin() + whole))
            << "cut at " << cut;
        const std::uint64_t end = whole == 0 ? 0 : log.events[whole - 1].EndBytes();
        ASSERT_EQ(read.damage.skipped_bytes, cut - end);
        ASSERT_EQ(read.damage.torn_bytes, cut - end);
    }
}

TEST_F(LcmLogReaderTest, FlippedBytesCostNoEventButTheirOwnAndInventNone) {
    RandomLog log(4, 150);
    std::set<std::uint64_t> starts;
    for (const OwnedEvent& event : log.events) starts.insert(event.position_bytes);
    for (int i = 0; i < 1000; ++i) {
        LogBytes bytes = log.bytes;
        std::set<std::uint64_t> flipped;
        for (int n = log.Up(19); n >= 0; --n) {
            const auto at = static_cast<std::size_t>(log.Up(static_cast<int>(bytes.size()) - 1));
            bytes[at] ^= static_cast<std::uint8_t>(1 + log.Up(254));
            flipped.insert(at);
        }
        const ReadLog read = ReadAll(bytes);
        for (const OwnedEvent& event : read.events)
            ASSERT_TRUE(starts.contains(event.position_bytes)) << "round " << i;
        for (const OwnedEvent& event : log.events) {
            const auto hit = flipped.lower_bound(event.position_bytes);
            if (hit != flipped.end() && *hit < event.EndBytes()) continue;
            ASSERT_EQ(std::ranges::count(read.events, event), 1)
                << "round " << i << ", event at " << event.position_bytes;
        }
    }
}

TEST_F(LcmLogReaderTest, EveryBitOfALengthMayFlipWithoutAnEventInventedOrAnotherLost) {
    RandomLog log(5, 0);
    for (int i = 0; i < 300; ++i) log.Append(1'700'000'000'000'000 + i, "CAM_1", LogBytes(223, 7));
    const std::uint64_t lengths = log.events[20].position_bytes + 20;
    for (int bit = 0; bit < 64; ++bit) {
        LogBytes bytes = log.bytes;
        bytes[lengths + bit / 8] ^= static_cast<std::uint8_t>(1U << bit % 8);
        const ReadLog read = ReadAll(bytes);
        ASSERT_EQ(read.events.size(), log.events.size() - 1) << "bit " << bit;
        ASSERT_EQ(read.damage.lost_events, 1U);
        ASSERT_EQ(read.damage.skipped_bytes, 256U);
    }
}

TEST_F(LcmLogReaderTest, GoesOnBehindAPieceThatWasOverwritten) {
    const RandomLog log(6, 100);
    LogBytes bytes = log.bytes;
    const std::uint64_t from = log.events[40].position_bytes + 1;
    const std::uint64_t until = log.events[50].EndBytes() - 1;
    std::fill(bytes.begin() + from, bytes.begin() + until, std::uint8_t{0});
    const ReadLog read = ReadAll(bytes);
    EXPECT_EQ(read.damage.places, 1U);
    EXPECT_EQ(read.events.size(), log.events.size() - 11);
    EXPECT_EQ(read.damage.lost_events, 11U);
    EXPECT_EQ(read.events.back(), log.events.back());
}

TEST_F(LcmLogReaderTest, KeepsTheLastEventBeforeZerosThatAPowerCutLeft) {
    const RandomLog log(12, 20);
    LogBytes bytes = log.bytes;
    bytes.resize(bytes.size() + 10000);
    const ReadLog read = ReadAll(bytes);
    EXPECT_EQ(read.events, log.events);
    EXPECT_EQ(read.damage.torn_bytes, 10000U);
}

TEST_F(LcmLogReaderTest, AnEventThatEndsInSuchZerosIsTorn) {
    RandomLog log(13, 20);
    log.Append(1'700'000'001'000'000, "CAM_1", LogBytes(1000, 7));
    LogBytes bytes = log.bytes;
    std::fill(bytes.end() - 500, bytes.end(), std::uint8_t{0});
    bytes.resize(bytes.size() + 10000);
    EXPECT_EQ(ReadAll(bytes).events.size(), 20U);
}

TEST_F(LcmLogReaderTest, ALengthThatNothingConfirmsTakesNoMemory) {
    RandomLog log(14, 3);
    log.Append(1'700'000'001'000'000, "CAM_1", LogBytes(std::size_t{20} << 20, 7));
    log.Append(1'700'000'001'000'001, "CAM_1", LogBytes(std::size_t{20} << 20, 7));
    LogBytes bytes = log.bytes;
    bytes[log.events[3].position_bytes + 25] ^= 0x80;  // ends in the middle of the next one
    tests::WriteBytes(file_, bytes);
    auto reader = LcmLogReader::Open(file_);
    for (int i = 0; i < 3; ++i) ASSERT_TRUE((*reader)->Next().ok());
    const std::uint64_t before = tests::HeapCallsOfThisThread();
    ASSERT_EQ((*reader)->Next().value().number, 4);
    const std::uint64_t of_the_one_that_is_read = tests::kHeapCallsAreCounted ? 1 : 0;
    EXPECT_EQ(tests::HeapCallsOfThisThread() - before, of_the_one_that_is_read);
}

TEST_F(LcmLogReaderTest, AMessageAboveTheLimitIsDamage) {
    RandomLog log(7, 0);
    log.Append(1, "SMALL", LogBytes(1000));
    log.Append(2, "LARGE", LogBytes(1001));
    log.Append(3, "SMALL", LogBytes(1000));
    const ReadLog read = ReadAll(log.bytes, {.max_data_bytes = 1000});
    EXPECT_EQ(read.events, (std::vector{log.events[0], log.events[2]}));
}

TEST_F(LcmLogReaderTest, LogsThatWerePutTogetherAreReadToTheEnd) {
    const RandomLog early(8, 50);
    const RandomLog late(9, 60);
    LogBytes bytes = early.bytes;
    bytes.insert(bytes.end(), late.bytes.begin(), late.bytes.end());
    EXPECT_EQ(ReadAll(bytes).events.size(), 110U);
}

TEST_F(LcmLogReaderTest, ReadsAMessageLargerThanItsMemory) {
    RandomLog log(10, 3);
    log.Append(1'700'000'000'100'000, "LARGE", LogBytes(3 * LcmLogWindow::kBytes, 9));
    log.Append(1'700'000'000'100'001, "SMALL", LogBytes(3, 9));
    EXPECT_EQ(ReadAll(log.bytes).events, log.events);
}

TEST_F(LcmLogReaderTest, SeeksToTheFirstEventOfATime) {
    RandomLog log(11, 4000);
    ASSERT_GT(log.bytes.size(), 3 * LcmLogWindow::kBytes);
    tests::WriteBytes(file_, log.bytes);
    auto reader = LcmLogReader::Open(file_);
    for (int i = 0; i < 200; ++i) {
        const OwnedEvent& wanted = log.events[static_cast<std::size_t>(log.Up(3999))];
        const auto first =
            std::ranges::lower_bound(log.events, wanted.utime_us, {}, &OwnedEvent::utime_us);
        ASSERT_TRUE((*reader)->SeekToTime(wanted.utime_us).ok());
        auto event = (*reader)->Next();
        ASSERT_EQ(OwnedEvent(event.value()), *first);
    }
    EXPECT_EQ((*reader)->SeekToTime(log.events.back().utime_us + 1).error(),
              hal::Error::kEndOfStream);
    EXPECT_EQ((*reader)->damage().skipped_bytes, 0U);
}

TEST_F(LcmLogReaderTest, SaysWhichFileCannotBeRead) {
    const auto reader = LcmLogReader::Open(folder_ / "absent.lcm");
    ASSERT_FALSE(reader.ok());
    EXPECT_NE(reader.error().find("absent.lcm: cannot be read"), std::string::npos);
    EXPECT_FALSE(LcmLogReader::Open(folder_.path()).ok());
}

}  // namespace
}  // namespace hitchview::drivers
