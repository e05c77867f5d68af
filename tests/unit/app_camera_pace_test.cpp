#include <gtest/gtest.h>

#include "app/camera_pace.hpp"
#include "app/frame_inbox.hpp"

namespace hitchview::app {
namespace {

using std::chrono::milliseconds;

/// Frames at 40 ms, numbered from `sequence` on.
void AddFrames(CameraPace& pace, int frames, std::uint32_t sequence, milliseconds first_at) {
    for (int i = 0; i < frames; ++i) {
        pace.Add({sequence + static_cast<std::uint32_t>(i), first_at + i * milliseconds(40)});
    }
}

TEST(CameraPaceTest, OneFrameHasNoPeriod) {
    CameraPace pace;
    AddFrames(pace, 1, 0, milliseconds(7));
    EXPECT_FALSE(pace.period_ms());
}

TEST(CameraPaceTest, LostFramesThatAreNumberedDoNotMatter) {
    CameraPace pace;
    AddFrames(pace, 10, 4'294'967'290, milliseconds(7));
    AddFrames(pace, 10, 10, milliseconds(7 + 16 * 40));
    EXPECT_DOUBLE_EQ(pace.period_ms().value(), 40);
}

TEST(CameraPaceTest, TimeInWhichACameraWasAwayIsNoPartOfItsPeriod) {
    hal::FramePool pool({16, 16}, 4);
    FrameInbox inbox(1, milliseconds(0));
    const auto put = [&](std::uint32_t sequence, milliseconds at) {
        inbox.Put(0, pool.Lease(pool.Take().value(), {sequence, at}), at);
    };
    for (std::uint32_t i = 0; i < 10; ++i) put(i, i * milliseconds(40));
    inbox.SetConnected(0, false);
    for (std::uint32_t i = 10; i < 20; ++i) put(i, milliseconds(60'000) + i * milliseconds(40));
    EXPECT_DOUBLE_EQ(inbox.pace(0).period_ms().value(), 40);
}

TEST(CameraPaceTest, AStampThatStepsBackIsMeasuredAfresh) {
    CameraPace pace;
    AddFrames(pace, 10, 0, milliseconds(60'000));
    AddFrames(pace, 10, 10, milliseconds(7));
    EXPECT_DOUBLE_EQ(pace.period_ms().value(), 40);
}

}  // namespace
}  // namespace hitchview::app
