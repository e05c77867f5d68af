#include <gtest/gtest.h>

#include <algorithm>

#include "app/frame_deadlines.hpp"

namespace hitchview::app {
namespace {

using std::chrono::milliseconds;

constexpr hal::Instant kStart = std::chrono::seconds(100);
constexpr hal::Instant kPeriod = milliseconds(30);

/// A set that was there when it was asked for.
FrameDeadlines::Turn JudgeReady(FrameDeadlines& deadlines, std::uint32_t sequence,
                                hal::Instant now) {
    return deadlines.Judge(sequence, now, now);
}

TEST(FrameDeadlinesTest, ASetInTimeIsDueAtItsPeriod) {
    FrameDeadlines deadlines(kStart, kPeriod);
    const auto turn = JudgeReady(deadlines, 3, kStart + milliseconds(50));
    EXPECT_FALSE(turn.dropped);
    EXPECT_FALSE(turn.hurried);
    EXPECT_EQ(turn.due, kStart + milliseconds(90));
}

TEST(FrameDeadlinesTest, ASetThatIsLateByMoreThanAPeriodIsDroppedAndCounted) {
    FrameDeadlines deadlines(kStart, kPeriod);
    EXPECT_FALSE(JudgeReady(deadlines, 1, kStart + milliseconds(60)).dropped);
    EXPECT_TRUE(JudgeReady(deadlines, 1, kStart + milliseconds(61)).dropped);
    EXPECT_EQ(deadlines.dropped(), 1U);
}

TEST(FrameDeadlinesTest, WorkThatTakesTwiceItsTimeDropsEverySecondSetAndLatencyStays) {
    FrameDeadlines deadlines(kStart, kPeriod);
    hal::Instant now = kStart;
    hal::Instant longest_latency{};
    for (std::uint32_t sequence = 0; sequence < 1000; ++sequence) {
        const auto turn = JudgeReady(deadlines, sequence, now);
        if (turn.dropped) continue;
        now = std::max(now, turn.due) + 2 * kPeriod;
        deadlines.Add(2 * kPeriod);
        longest_latency = std::max(longest_latency, now - turn.due);
    }
    EXPECT_NEAR(static_cast<double>(deadlines.dropped()), 500, 2);
    EXPECT_EQ(deadlines.misses() + deadlines.dropped(), 1000U);
    EXPECT_LE(longest_latency, 3 * kPeriod);
}

TEST(FrameDeadlinesTest, AfterALongSetTheNextOneIsHurried) {
    FrameDeadlines deadlines(kStart, kPeriod);
    deadlines.Add(kPeriod + milliseconds(1));
    EXPECT_TRUE(JudgeReady(deadlines, 0, kStart).hurried);
    deadlines.Add(kPeriod - milliseconds(1));
    EXPECT_FALSE(JudgeReady(deadlines, 1, kStart).hurried);
    EXPECT_TRUE(JudgeReady(deadlines, 1, kStart + kPeriod + milliseconds(10)).hurried);
}

TEST(FrameDeadlinesTest, AllSetsOfASlowSourceAreShownAndTheStartSlips) {
    FrameDeadlines deadlines(kStart, kPeriod);
    hal::Instant now = kStart;
    for (std::uint32_t sequence = 0; sequence < 100; ++sequence) {
        const hal::Instant asked = now;
        now += 3 * kPeriod;
        const auto turn = deadlines.Judge(sequence, asked, now);
        EXPECT_FALSE(turn.dropped);
        EXPECT_LE(now - turn.due, milliseconds(500));
    }
    EXPECT_EQ(deadlines.dropped(), 0U);
    EXPECT_GT(deadlines.start(), kStart);
}

}  // namespace
}  // namespace hitchview::app
