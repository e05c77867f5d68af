#include <gtest/gtest.h>

#include <cstdlib>
#include <filesystem>

#include "drivers/replay_camera.hpp"
#include "tests/support/test_data.hpp"

namespace hitchview::drivers {
namespace {

struct Recording {
    const char* path;
    int frames;  ///< as `ffprobe -count_frames` finds
};

class RecordingTest : public testing::TestWithParam<Recording> {};

TEST_P(RecordingTest, EveryDecodedFrameIsOneFrame) {
    const std::string path = tests::TestData(GetParam().path);
    if (path.empty()) GTEST_SKIP() << "no recording " << GetParam().path;
    const auto camera = ReplayCamera::Open(path, {.name = "test"});
    ASSERT_TRUE(camera) << camera.error();
    int frames = 0;
    for (;;) {
        const auto frame = camera.value()->WaitFrame(std::chrono::seconds(30));
        if (!frame) {
            EXPECT_EQ(frame.error(), hal::Error::kEndOfStream);
            break;
        }
        EXPECT_EQ(frame.value().view().header.sequence, static_cast<unsigned>(frames++));
    }
    EXPECT_EQ(frames, GetParam().frames);
}

INSTANTIATE_TEST_SUITE_P(Recordings, RecordingTest,
                         testing::Values(Recording{"clips/test1.avi", 73},
                                         Recording{"clips/test2.avi", 55},
                                         Recording{"clips/video-10.m4v", 249},
                                         Recording{"clips/video-3.m4v", 246},
                                         Recording{"clips/road-forward.mp4", 108},
                                         Recording{"pairs/rooftop/left.mp4", 296},
                                         Recording{"pairs/rooftop/right.mp4", 299},
                                         Recording{"pairs/stereo-drive-1/tractor.avi", 51}));

}  // namespace
}  // namespace hitchview::drivers
