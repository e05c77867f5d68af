#include <gtest/gtest.h>

#include "drivers/steady_clock.hpp"

namespace hitchview::drivers {
namespace {

using std::chrono::milliseconds;

TEST(SteadyClockTest, ASleepNeverEndsBeforeItsMoment) {
    SteadyClock clock;
    const hal::Instant when = clock.Now() + milliseconds(3);
    clock.SleepUntil(when);
    EXPECT_GE(clock.Now(), when);
}

TEST(SteadyClockTest, AMomentThatHasPassedIsNotWaitedFor) {
    SteadyClock clock;
    clock.SleepUntil(clock.Now() - milliseconds(3));
    clock.SleepUntil(hal::Instant(0));
}

TEST(SteadyClockTest, EpochTimeIsTheWallClocks) {
    const SteadyClock clock;
    const auto epoch_us = clock.EpochMicroseconds(clock.Now());
    const auto wall = std::chrono::system_clock::now().time_since_epoch();
    EXPECT_NEAR(
        static_cast<double>(epoch_us),
        static_cast<double>(std::chrono::duration_cast<std::chrono::microseconds>(wall).count()),
        2e6);
}

}  // namespace
}  // namespace hitchview::drivers
