#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <vector>

#include "drivers/frame_loop.hpp"
#include "drivers/looped_camera.hpp"
#include "hal/fake_clock.hpp"
#include "tests/support/heap_calls.hpp"

namespace hitchview::drivers {
namespace {

using std::chrono::milliseconds;

constexpr hal::FrameFormat kFormat{16, 8, hal::PixelFormat::kNv12, hal::Range::kFull};
constexpr hal::Instant kPeriod = milliseconds(40);
constexpr hal::Instant kStart = std::chrono::seconds(1000);
constexpr std::array kCameras{1, 4};
constexpr int kFrames = 4;
/// Of camera 4 only.
constexpr int kNotGiven = 2;

std::uint8_t GreyOf(int camera, int frame) {
    return static_cast<std::uint8_t>(10 * camera + frame);
}

/// Every byte of a frame tells its camera and number.
LoopedFrames GreyFrames() {
    return {kFormat, kCameras, kFrames, [](int camera, int frame, std::span<std::uint8_t> out) {
                std::ranges::fill(out, GreyOf(camera, frame));
                return camera != 4 || frame != kNotGiven;
            }};
}

/// What the frame shows; -1: not one grey throughout.
int GreyIn(const hal::FrameLease& frame) {
    const std::uint8_t* const bytes = frame.view().planes[0].data;
    const std::span<const std::uint8_t> all(bytes, hal::FrameBytes(kFormat));
    const bool uniform = std::ranges::all_of(all, [&](std::uint8_t b) { return b == all[0]; });
    return uniform ? all[0] : -1;
}

TEST(ForthAndBackTest, TurnsAtBothEnds) {
    std::vector<int> places;
    for (int way = 0; way < 9; ++way) places.push_back(ForthAndBack(way, 3));
    EXPECT_EQ(places, (std::vector{0, 1, 2, 3, 2, 1, 0, 1, 2}));
}

TEST(LoopedFramesTest, EachCameraShowsItsFirstFramesForthAndBack) {
    const LoopedFrames sut = GreyFrames();
    EXPECT_EQ(sut.format(), kFormat);
    const std::vector expected{0, 1, 2, 3, 2, 1, 0, 1};
    for (std::size_t i = 0; i < expected.size(); ++i) {
        const auto bytes = sut.Frame(1, i);
        ASSERT_EQ(bytes.size(), hal::FrameBytes(kFormat));
        EXPECT_EQ(bytes.back(), GreyOf(1, expected[i]));
    }
    EXPECT_EQ(sut.Frame(4, 3).front(), GreyOf(4, 3));
    EXPECT_TRUE(sut.Frame(4, kNotGiven).empty());
    // A week at 30 Hz is a whole number of turns.
    EXPECT_EQ(sut.Frame(1, 18'144'000 + 1).front(), GreyOf(1, 1));
}

TEST(LoopedCameraTest, SkipsNoFrameAndEnds) {
    const LoopedFrames frames = GreyFrames();
    LoopedCamera sut(frames, {.camera = 1, .period = kPeriod, .start = kStart, .frames = 20});
    EXPECT_EQ(sut.format(), kFormat);
    for (int i = 0; i < 20; ++i) {
        auto frame = sut.WaitFrame(milliseconds(1));
        ASSERT_TRUE(frame.ok());
        EXPECT_EQ(frame->view().header.sequence, static_cast<std::uint32_t>(i));
        EXPECT_EQ(frame->view().header.captured_at, kStart + i * kPeriod);
        EXPECT_EQ(GreyIn(*frame), GreyOf(1, ForthAndBack(i, kFrames - 1)));
    }
    EXPECT_EQ(sut.WaitFrame(milliseconds(1)).error(), hal::Error::kEndOfStream);
}

TEST(LoopedCameraTest, AFrameThatTheDriveLacksIsCorrupted) {
    const LoopedFrames frames = GreyFrames();
    LoopedCamera sut(frames, {.camera = 4, .period = kPeriod, .start = {}, .frames = 4});
    EXPECT_TRUE(sut.WaitFrame(milliseconds(1)));
    EXPECT_TRUE(sut.WaitFrame(milliseconds(1)));
    EXPECT_EQ(sut.WaitFrame(milliseconds(1)).error(), hal::Error::kCorrupted);
    EXPECT_EQ(sut.WaitFrame(milliseconds(1))->view().header.sequence, 3U);
}

TEST(LoopedCameraTest, TimesOutWhileEveryFrameIsLentAndSkipsNone) {
    const LoopedFrames frames = GreyFrames();
    LoopedCamera sut(frames, {.camera = 1, .period = kPeriod, .start = {}, .slots = 1});
    {
        const auto first = sut.WaitFrame(milliseconds(1));
        ASSERT_TRUE(first);
        EXPECT_EQ(sut.WaitFrame(milliseconds(1)).error(), hal::Error::kTimeout);
    }
    EXPECT_EQ(sut.WaitFrame(milliseconds(1))->view().header.sequence, 1U);
}

class LoopedLiveCameraTest : public testing::Test {
 protected:
    LoopedLiveCameraTest() { clock_.Advance(kStart); }

    LoopedLiveCamera Camera(int slots, int camera = 1) {
        return {frames_,
                {.camera = camera, .period = kPeriod, .start = kStart, .slots = slots},
                clock_};
    }

    const LoopedFrames frames_ = GreyFrames();
    hal::FakeClock clock_;
};

TEST_F(LoopedLiveCameraTest, EachFrameIsThereAtItsMoment) {
    LoopedLiveCamera sut = Camera(3);
    for (int i = 0; i < 20; ++i) {
        auto frame = sut.WaitFrame(milliseconds(100));
        ASSERT_TRUE(frame);
        EXPECT_EQ(clock_.Now(), kStart + i * kPeriod);
        EXPECT_EQ(frame->view().header.captured_at, clock_.Now());
        EXPECT_EQ(frame->view().header.sequence, static_cast<std::uint32_t>(i));
        EXPECT_EQ(GreyIn(*frame), GreyOf(1, ForthAndBack(i, kFrames - 1)));
    }
    EXPECT_EQ(sut.counts().delivered, 20U);
    EXPECT_EQ(sut.counts().lost, 0U);
}

TEST_F(LoopedLiveCameraTest, AWaitEndsAtItsTimeout) {
    LoopedLiveCamera sut = Camera(3);
    ASSERT_TRUE(sut.WaitFrame(milliseconds(1)));
    EXPECT_EQ(sut.WaitFrame(milliseconds(15)).error(), hal::Error::kTimeout);
    EXPECT_EQ(clock_.Now(), kStart + milliseconds(15));
    EXPECT_TRUE(sut.WaitFrame(milliseconds(25)));  // the moment itself is in time
    EXPECT_EQ(clock_.Now(), kStart + kPeriod);
}

TEST_F(LoopedLiveCameraTest, WhoReadsLateGetsTheOldestAndLosesWhatFoundNoRoom) {
    LoopedLiveCamera sut = Camera(3);
    ASSERT_TRUE(sut.WaitFrame(milliseconds(1)));
    clock_.Advance(5 * kPeriod);  // 1 2 3 fill the slots, 4 5 are lost
    std::vector<std::uint32_t> numbers;
    std::vector<hal::Instant> moments;
    for (int i = 0; i < 4; ++i) {
        auto frame = sut.WaitFrame(milliseconds(100));
        ASSERT_TRUE(frame);
        numbers.push_back(frame->view().header.sequence);
        moments.push_back(frame->view().header.captured_at - kStart);
    }
    EXPECT_EQ(numbers, (std::vector{1U, 2U, 3U, 6U}));
    EXPECT_EQ(moments, (std::vector<hal::Instant>{kPeriod, 2 * kPeriod, 3 * kPeriod, 6 * kPeriod}));
    EXPECT_EQ(sut.counts().delivered, 5U);
    EXPECT_EQ(sut.counts().lost, 2U);
    EXPECT_EQ(sut.pool().low_water, 0);
}

TEST_F(LoopedLiveCameraTest, FramesAreLostWhileAllAreLent) {
    LoopedLiveCamera sut = Camera(1);
    {
        auto held = sut.WaitFrame(milliseconds(1));
        ASSERT_TRUE(held);
        EXPECT_EQ(sut.WaitFrame(milliseconds(100)).error(), hal::Error::kTimeout);
        EXPECT_EQ(clock_.Now(), kStart + milliseconds(100));
        EXPECT_EQ(GreyIn(*held), GreyOf(1, 0)) << "a frame that is lent is left alone";
    }
    EXPECT_EQ(sut.WaitFrame(milliseconds(100))->view().header.sequence, 3U);
    EXPECT_EQ(sut.counts().lost, 2U);
}

TEST_F(LoopedLiveCameraTest, AFrameThatTheDriveLacksIsCorruptedAndCounted) {
    LoopedLiveCamera sut = Camera(2, 4);
    ASSERT_TRUE(sut.WaitFrame(milliseconds(100)));
    ASSERT_TRUE(sut.WaitFrame(milliseconds(100)));
    EXPECT_EQ(sut.WaitFrame(milliseconds(100)).error(), hal::Error::kCorrupted);
    EXPECT_EQ(sut.WaitFrame(milliseconds(100))->view().header.sequence, 3U);
    EXPECT_EQ(sut.counts().corrupted, 1U);
    EXPECT_EQ(sut.counts().lost, 0U);
}

TEST_F(LoopedLiveCameraTest, ReopenedItIsThereAtOnceAndWhatCameMeanwhileIsForgotten) {
    LoopedLiveCamera sut = Camera(2);
    auto lent = sut.WaitFrame(milliseconds(1));
    clock_.Advance(3 * kPeriod + milliseconds(5));
    ASSERT_TRUE(sut.Reopen());
    auto frame = sut.WaitFrame(milliseconds(100));
    ASSERT_TRUE(frame);
    EXPECT_EQ(frame->view().header.captured_at, kStart + 4 * kPeriod);
    EXPECT_EQ(frame->view().header.sequence, 1U) << "nobody counts what came while it was gone";
    EXPECT_EQ(GreyIn(*frame), GreyOf(1, 2));
    EXPECT_EQ(GreyIn(*lent), GreyOf(1, 0));
    EXPECT_EQ(sut.counts().reopened, 1U);
    EXPECT_EQ(sut.counts().lost, 0U);
}

TEST_F(LoopedLiveCameraTest, WhatWaitsWhenItIsReopenedLeavesItsRoom) {
    LoopedLiveCamera sut = Camera(3);
    ASSERT_TRUE(sut.WaitFrame(milliseconds(1)));
    clock_.Advance(3 * kPeriod);
    ASSERT_TRUE(sut.WaitFrame(milliseconds(1)));  // two more wait
    ASSERT_TRUE(sut.Reopen());
    std::vector<hal::Result<hal::FrameLease>> held;
    for (int i = 0; i < 3; ++i) {
        held.push_back(sut.WaitFrame(milliseconds(100)));
        ASSERT_TRUE(held.back());
        EXPECT_EQ(held.back()->view().header.captured_at, kStart + (4 + i) * kPeriod);
    }
}

TEST_F(LoopedLiveCameraTest, TakesNoMemoryOnceItIsThere) {
    if (!tests::kHeapCallsAreCounted) GTEST_SKIP() << "a sanitizer owns malloc";
    LoopedLiveCamera sut = Camera(2);
    const std::uint64_t before = tests::HeapCallsOfThisThread();
    for (int i = 0; i < 50; ++i) {
        if (i % 10 == 9) clock_.Advance(7 * kPeriod);
        const bool reopens = i % 20 == 19;
        ASSERT_TRUE(!reopens || sut.Reopen());
        ASSERT_TRUE(sut.WaitFrame(milliseconds(100)));
    }
    EXPECT_EQ(tests::HeapCallsOfThisThread(), before);
}

}  // namespace
}  // namespace hitchview::drivers
