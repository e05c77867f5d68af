#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <numbers>
#include <vector>

#include "drivers/simulated_camera.hpp"
#include "drivers/simulated_can_bus.hpp"
#include "hal/fake_clock.hpp"
#include "tests/support/simulated_pictures.hpp"

namespace hitchview::drivers {
namespace {

using std::chrono::milliseconds;

constexpr hal::Instant kStart = std::chrono::seconds(1000);

std::unique_ptr<SimulatedRig> TinyRig(int frames) {
    SimulationOptions options;
    options.frames = frames;
    options.width_px = 64;
    options.height_px = 36;
    return tests::Rig(options);
}

TEST(SimulatedCameraTest, DeliversEveryFrameOfTheDriveThenTheEnd) {
    const auto rig = TinyRig(3);
    SimulatedCamera sut(*rig, 1, kStart);
    EXPECT_EQ(sut.format(), rig->format());
    Renderer::Workspace workspace;
    std::vector<std::uint8_t> expected(hal::FrameBytes(rig->format()));
    for (int i = 0; i < 3; ++i) {
        const auto frame_result = sut.WaitFrame(milliseconds(100));
        ASSERT_TRUE(frame_result.ok());
        const hal::FrameView& view = frame_result.value().view();
        EXPECT_EQ(view.header.sequence, static_cast<std::uint32_t>(i));
        EXPECT_EQ(view.header.captured_at, kStart + i * rig->options().period);
        rig->Render(1, i, workspace, expected);
        EXPECT_TRUE(std::equal(expected.begin(), expected.end(), view.planes[0].data));
    }
    EXPECT_EQ(sut.WaitFrame(milliseconds(100)).error(), hal::Error::kEndOfStream);
}

TEST(SimulatedCameraTest, TimesOutWhileEveryFrameIsLentAndSkipsNone) {
    const auto rig = TinyRig(4);
    SimulatedCamera sut(*rig, 0, kStart, 2);
    {
        const auto first = sut.WaitFrame(milliseconds(1));
        const auto second = sut.WaitFrame(milliseconds(1));
        ASSERT_TRUE(first.ok() && second.ok());
        EXPECT_EQ(sut.WaitFrame(milliseconds(1)).error(), hal::Error::kTimeout);
    }
    EXPECT_EQ(sut.WaitFrame(milliseconds(1)).value().view().header.sequence, 2U);
}

/// DBC: bit `start` is the most significant of `length`; bytes follow upwards, bits downwards.
std::uint32_t DecodeMotorola(const hal::CanFrame& frame, int start, int length) {
    std::uint32_t raw = 0;
    int byte = start / 8;
    int bit = start % 8;
    for (int i = 0; i < length; ++i) {
        raw = raw << 1 | (frame.data[static_cast<std::size_t>(byte)] >> bit & 1U);
        if (--bit < 0) {
            bit = 7;
            ++byte;
        }
    }
    return raw;
}

TEST(SimulatedCanBusTest, SendsTheHitchAngleEveryTwentyMilliseconds) {
    const auto rig = TinyRig(91);
    SimulatedCanBus sut(*rig, kStart);
    int frames = 0;
    double largest_deg = 0;
    for (auto next = sut.WaitFrame(milliseconds(1)); next.ok();
         next = sut.WaitFrame(milliseconds(1))) {
        const hal::CanFrame& frame = next.value();
        EXPECT_EQ(frame.id, 1111U);
        EXPECT_FALSE(frame.extended);
        EXPECT_EQ(frame.size_bytes, 8);
        EXPECT_EQ(frame.received_at, kStart + frames * milliseconds(20));
        const double angle_deg = DecodeMotorola(frame, 23, 12) * 0.1 - 90;
        const double truth_deg =
            rig->HitchAngleAt(frame.received_at - kStart) * 180 / std::numbers::pi;
        EXPECT_NEAR(angle_deg, truth_deg, 0.0501);
        largest_deg = std::max(largest_deg, std::abs(angle_deg));
        ++frames;
    }
    EXPECT_EQ(frames, 150);  // 90 periods of 33.3 ms end just before 3 s
    EXPECT_GT(largest_deg, 5);
    EXPECT_EQ(sut.WaitFrame(milliseconds(1)).error(), hal::Error::kEndOfStream);
}

TEST(SimulatedCanBusTest, OfALoopItTellsWhatTheFramesShow) {
    const auto rig = TinyRig(91);
    constexpr int kLoop = 31;  // a turn each second
    SimulatedCanBus sut(*rig, {.start = kStart, .frames = 241, .loop_frames = kLoop});
    SimulatedCanBus once(*rig, kStart);
    std::vector<hal::CanFrame> way;
    for (int i = 0; i <= 50; ++i) way.push_back(once.WaitFrame(milliseconds(1)).value());
    int frames = 0;
    for (auto next = sut.WaitFrame(milliseconds(1)); next.ok();
         next = sut.WaitFrame(milliseconds(1)), ++frames) {
        const int along = frames % 100;
        // Nearly: 30 periods are 10 ns short of a second.
        EXPECT_NEAR(
            DecodeMotorola(next.value(), 23, 12),
            DecodeMotorola(way[static_cast<std::size_t>(std::min(along, 100 - along))], 23, 12), 1);
        EXPECT_EQ(next.value().received_at, kStart + frames * milliseconds(20));
    }
    EXPECT_EQ(frames, 400);  // 240 periods end just before 8 s
}

TEST(SimulatedCanBusTest, WithAClockItsFramesComeAtTheirMoments) {
    const auto rig = TinyRig(91);
    hal::FakeClock clock;
    clock.Advance(kStart);
    SimulatedCanBus sut(*rig, {.start = kStart, .frames = 1, .loop_frames = 31, .clock = &clock});
    for (int i = 0; i < 300; ++i) {
        auto frame = sut.WaitFrame(milliseconds(30));
        ASSERT_TRUE(frame);
        EXPECT_EQ(frame->received_at, kStart + i * milliseconds(20));
        EXPECT_EQ(clock.Now(), frame->received_at);
    }
    EXPECT_EQ(sut.WaitFrame(milliseconds(5)).error(), hal::Error::kTimeout);
    EXPECT_EQ(clock.Now(), kStart + 299 * milliseconds(20) + milliseconds(5));
}

}  // namespace
}  // namespace hitchview::drivers
