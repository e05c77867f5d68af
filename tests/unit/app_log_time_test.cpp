#include <gtest/gtest.h>

#include "app/log_time.hpp"
#include "app/log_timeline.hpp"

namespace hitchview::app {
namespace {

using hal::Instant;
using std::chrono::hours;
using std::chrono::milliseconds;
using std::chrono::seconds;

constexpr Instant kPeriod = milliseconds(40);
constexpr std::int64_t kStart_us = 1'700'000'000'000'000;

TEST(LogTimeTest, SecondsCountFromTheStart) {
    EXPECT_EQ(ParseLogTime("0", kStart_us), kStart_us);
    EXPECT_EQ(ParseLogTime("12.5", kStart_us), kStart_us + 12'500'000);
}

TEST(LogTimeTest, TimesOfTheCalendarReadBack) {
    for (const std::int64_t utime_us : {std::int64_t{0}, kStart_us, kStart_us + 123'456})
        EXPECT_EQ(ParseLogTime(UtcText(utime_us), 5), utime_us);
    EXPECT_EQ(ParseLogTime("2023-11-14T22:13:20", 5), kStart_us);
    EXPECT_EQ(ParseLogTime("2023-11-14T22:13:20.5", 5), kStart_us + 500'000);
}

TEST(LogTimeTest, EverythingElseIsRefused) {
    for (const char* text :
         {"", "-1", "1e99", "nan", "12 ", "2023-11-14", "2023-11-14T22:13:20+01:00",
          "2023-11-14T22:13:20.", "2023-11-14T22:13:20.5.5", "later"})
        EXPECT_FALSE(ParseLogTime(text, kStart_us).has_value()) << text;
}

TEST(LogTimelineTest, ItBeginsWithTheFirstFrame) {
    LogTimeline timeline(kPeriod);
    EXPECT_FALSE(timeline.MomentOf(hours(5)).has_value());
    EXPECT_EQ(timeline.Add(hours(5)), Instant(0));
    EXPECT_EQ(timeline.Add(hours(5) + kPeriod), kPeriod);
    EXPECT_EQ(timeline.MomentOf(hours(5) + milliseconds(3)), Instant(milliseconds(3)));
}

TEST(LogTimelineTest, OneDamagedMomentIsPassedOver) {
    LogTimeline timeline(kPeriod);
    timeline.Add(hours(5));
    EXPECT_FALSE(timeline.Add(hours(5000)).has_value());
    EXPECT_EQ(timeline.Add(hours(5) + kPeriod), kPeriod);
    EXPECT_FALSE(timeline.Add(Instant(7)).has_value());
    EXPECT_EQ(timeline.Add(hours(5) + 2 * kPeriod), 2 * kPeriod);
    EXPECT_FALSE(timeline.MomentOf(hours(5000)).has_value());
}

TEST(LogTimelineTest, AJumpOfTheClockTakesAPeriod) {
    LogTimeline timeline(kPeriod);
    timeline.Add(hours(5));
    EXPECT_FALSE(timeline.Add(seconds(3)).has_value());  // the machine was started again
    EXPECT_EQ(timeline.Add(seconds(3) + kPeriod), kPeriod);
    EXPECT_EQ(timeline.Add(seconds(3) + 2 * kPeriod), 2 * kPeriod);
    EXPECT_EQ(timeline.MomentOf(seconds(3)), Instant(0));
}

}  // namespace
}  // namespace hitchview::app
