#include <gtest/gtest.h>

#include "app/camera_ahead.hpp"
#include "hal/fake_camera.hpp"

namespace hitchview::app {
namespace {

using hal::Error;
using hal::FakeFrame;
using std::chrono::milliseconds;

constexpr hal::FrameFormat kFormat{.width_px = 4, .height_px = 2};
constexpr milliseconds kPatience{2000};

FakeFrame Frame(std::uint32_t sequence) {
    return {.header = {.sequence = sequence}};
}

TEST(CameraAheadTest, HandsOnEverythingInOrder) {
    CameraAhead camera(
        std::make_unique<hal::FakeCamera>(
            kFormat,
            std::deque<hal::Result<FakeFrame>>{Frame(0), Frame(1), Error::kCorrupted, Frame(3)}),
        "front");
    for (const std::uint32_t sequence : {0U, 1U}) {
        const auto frame = camera.WaitFrame(kPatience);
        ASSERT_TRUE(frame);
        EXPECT_EQ(frame.value().view().header.sequence, sequence);
    }
    EXPECT_EQ(camera.WaitFrame(kPatience).error(), Error::kCorrupted);
    EXPECT_EQ(camera.WaitFrame(kPatience).value().view().header.sequence, 3U);
    EXPECT_EQ(camera.WaitFrame(kPatience).error(), Error::kEndOfStream);
    EXPECT_EQ(camera.WaitFrame(kPatience).error(), Error::kEndOfStream);
    EXPECT_EQ(camera.format(), kFormat);
}

TEST(CameraAheadTest, EndsWhileFramesWait) {
    std::deque<hal::Result<FakeFrame>> script;
    for (std::uint32_t i = 0; i < 20; ++i) script.push_back(Frame(i));
    CameraAhead camera(std::make_unique<hal::FakeCamera>(kFormat, script, 8), "front");
    EXPECT_TRUE(camera.WaitFrame(kPatience));
}

}  // namespace
}  // namespace hitchview::app
