#include <gtest/gtest.h>

#include "app/camera_pace.hpp"

namespace hitchview::app {
namespace {

using hal::FrameHeader;
using hal::Instant;
using std::chrono::microseconds;
using std::chrono::milliseconds;

constexpr Instant kPeriod = milliseconds(10);

TEST(CameraPaceTest, IsNotKnownBeforeTheSecondFrame) {
    CameraPace pace;
    EXPECT_FALSE(pace.period_ms());
    pace.Add({7, milliseconds(100)}, kPeriod);
    EXPECT_FALSE(pace.period_ms());
}

TEST(CameraPaceTest, FramesThatAreMissingCount) {
    CameraPace pace;
    for (const std::uint32_t i : {0U, 1U, 4U, 5U, 100U})
        pace.Add({i, i * Instant(microseconds(10'010))}, kPeriod);
    EXPECT_NEAR(*pace.period_ms(), 10.01, 1e-9);
}

TEST(CameraPaceTest, StampsThatTrembleDoNotMatter) {
    CameraPace pace;
    for (std::uint32_t i = 0; i <= 100; ++i)
        pace.Add({i, i * kPeriod + (i % 2 == 1 ? milliseconds(9) : milliseconds(0))}, kPeriod);
    EXPECT_NEAR(*pace.period_ms(), 10, 1e-9);
}

TEST(CameraPaceTest, TheTimeThatACameraWasAwayIsLeftOut) {
    for (const milliseconds away : {milliseconds(25), milliseconds(5000)}) {
        CameraPace pace;
        for (std::uint32_t i = 0; i < 10; ++i) pace.Add({i, i * kPeriod}, kPeriod);
        for (std::uint32_t i = 10; i < 20; ++i) pace.Add({i, away + i * kPeriod}, kPeriod);
        EXPECT_NEAR(*pace.period_ms(), 10, 1e-9);
    }
}

TEST(CameraPaceTest, NumbersMayWrap) {
    CameraPace pace;
    pace.Add({0xFFFFFFFF, milliseconds(10)}, kPeriod);
    pace.Add({1, milliseconds(30)}, kPeriod);
    EXPECT_NEAR(*pace.period_ms(), 10, 1e-9);
}

}  // namespace
}  // namespace hitchview::app
