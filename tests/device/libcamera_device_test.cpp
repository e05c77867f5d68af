#include <gtest/gtest.h>
#include <libcamera/camera.h>

#include <algorithm>
#include <chrono>
#include <cstdio>
#include <memory>
#include <set>
#include <string>
#include <vector>

#include "drivers/libcamera_camera.hpp"
#include "drivers/libcamera_session.hpp"
#include "tests/device/camera_follower.hpp"
#include "tests/device/vimc.hpp"

// The kernel's virtual media controller camera, through libcamera's pipeline of it.
namespace hitchview::drivers {
namespace {

using std::chrono::milliseconds;
using testing::HasSubstr;
using tests::CameraFollower;

class LibcameraTest : public tests::VimcTest {
 protected:
    /// vimc's scaler grants this size as it is.
    static LibcameraOptions Options() {
        LibcameraOptions options;
        options.name = "front";
        options.id = tests::kVimcCamera;
        options.width_px = 960;
        options.height_px = 540;
        options.rate_hz = 20;  // vimc has no rate to set
        return options;
    }
};

TEST_F(LibcameraTest, AnUnknownIdNamesTheCamerasThatThereAre) {
    LibcameraOptions options = Options();
    options.id = "nowhere";
    const auto camera = OpenLibcamera(options);
    ASSERT_FALSE(camera.ok());
    EXPECT_THAT(camera.error(), HasSubstr("nowhere: no such camera"));
    EXPECT_THAT(camera.error(), HasSubstr("'" + std::string(tests::kVimcCamera) + "'"));
}

TEST_F(LibcameraTest, DeliversFramesInOrderAndAccountsForEach) {
    constexpr std::uint64_t kFrames = 60;
    auto camera = OpenLibcamera(Options());
    ASSERT_TRUE(camera.ok()) << camera.error();
    EXPECT_EQ(camera.value()->format().width_px, 960);
    EXPECT_EQ(camera.value()->format().pixel_format, hal::PixelFormat::kNv12);
    hal::FrameHeader last{};
    std::uint64_t gaps = 0;
    const std::uint64_t heap_calls = tests::HeapCallsOfThisThread();
    for (std::uint64_t i = 0; i < kFrames; ++i) {
        const auto frame = camera.value()->WaitFrame(milliseconds(2000));
        ASSERT_TRUE(frame.ok()) << ToString(frame.error());
        const hal::FrameHeader header = frame.value().view().header;
        if (i > 0) {
            gaps += header.sequence - last.sequence - 1;
            ASSERT_GT(header.captured_at, last.captured_at);
        }
        last = header;
    }
    std::printf("heap calls per frame of the thread that waits: %.2f\n",
                static_cast<double>(tests::HeapCallsOfThisThread() - heap_calls) / kFrames);
    const auto age = std::chrono::steady_clock::now().time_since_epoch() - last.captured_at;
    EXPECT_GE(age, milliseconds(0));
    EXPECT_LT(age, milliseconds(2000));
    const hal::CameraCounts counts = camera.value()->counts();
    EXPECT_EQ(counts.delivered, kFrames);
    EXPECT_EQ(counts.lost, gaps);
    EXPECT_EQ(counts.corrupted, 0U);
}

TEST_F(LibcameraTest, FramesShowThePatternOfTheSensor) {
    auto camera = OpenLibcamera(Options());
    ASSERT_TRUE(camera.ok()) << camera.error();
    const auto frame = camera.value()->WaitFrame(milliseconds(2000));
    ASSERT_TRUE(frame.ok()) << ToString(frame.error());
    // Colour bars: several greys along a line, and colours.
    const hal::Plane& luma = frame.value().view().planes[0];
    const hal::Plane& chroma = frame.value().view().planes[1];
    const std::uint8_t* line = luma.data + std::ptrdiff_t{270} * luma.stride_bytes;
    EXPECT_GE(std::set<int>(line, line + 960).size(), 6U);
    const std::uint8_t* colours = chroma.data + std::ptrdiff_t{135} * chroma.stride_bytes;
    EXPECT_GE(std::set<int>(colours, colours + 960).size(), 6U);
}

TEST_F(LibcameraTest, ASizeThatThePipelineChangesIsAnErrorUnlessAccepted) {
    LibcameraOptions options = Options();
    options.width_px = 1280;
    options.height_px = 720;
    const auto refused = OpenLibcamera(options);
    ASSERT_FALSE(refused.ok());
    EXPECT_THAT(refused.error(), HasSubstr("wanted best 1280x720, granted "));
    EXPECT_THAT(refused.error(), HasSubstr("1278x720"));
    options.accept_granted_size = true;
    const auto accepted = OpenLibcamera(options);
    ASSERT_TRUE(accepted.ok()) << accepted.error();
    EXPECT_EQ(accepted.value()->format().width_px, 1278);
}

TEST_F(LibcameraTest, AControlOutOfItsRangeIsNamed) {
    LibcameraOptions options = Options();
    options.controls = {{"brightness", "3"}};
    const auto camera = OpenLibcamera(options);
    ASSERT_FALSE(camera.ok());
    EXPECT_THAT(camera.error(), HasSubstr("control Brightness is 3, must be [-1.0"));
    options.controls = {{"brightness", "0.5"}};
    EXPECT_TRUE(OpenLibcamera(options).ok());
}

// libcamera follows the unplugging of USB cameras only, not of vimc: its signal is given here.
TEST_F(LibcameraTest, ACameraThatIsLostComesBackAndLentFramesStay) {
    auto camera = OpenLibcamera(Options());
    ASSERT_TRUE(camera.ok()) << camera.error();
    const auto lent = camera.value()->WaitFrame(milliseconds(2000));
    ASSERT_TRUE(lent.ok()) << ToString(lent.error());
    const hal::Plane luma = lent.value().view().planes[0];
    const std::vector<std::uint8_t> before(luma.data, luma.data + 960 * 540);
    const CameraFollower follower(*camera.value());
    for (std::uint64_t times = 1; times <= 3; ++times) {
        ASSERT_TRUE(follower.AwaitFrames(5));
        LibcameraSession::Join().value()->Find(tests::kVimcCamera)->disconnected.emit();
        ASSERT_TRUE(CameraFollower::Await(
            [&] { return camera.value()->counts().reopened == times; }, milliseconds(10000)));
    }
    EXPECT_TRUE(follower.AwaitFrames(5));
    EXPECT_TRUE(follower.in_order());
    EXPECT_GE(follower.answers(hal::Error::kDisconnected), 3);
    EXPECT_TRUE(std::equal(before.begin(), before.end(), luma.data));
    EXPECT_EQ(camera.value()->counts().corrupted, 0U);
}

TEST_F(LibcameraTest, ASilentCameraIsGivenUpUntilItIsReopened) {
    LibcameraOptions options = Options();
    options.rate_hz = 1000;  // vimc needs 50 ms to a frame: far beyond its patience
    options.silence_periods = 2;
    auto camera = OpenLibcamera(options);
    ASSERT_TRUE(camera.ok()) << camera.error();
    hal::Error answer = hal::Error::kTimeout;
    for (int i = 0; i < 100 && answer != hal::Error::kDisconnected; ++i) {
        const auto frame = camera.value()->WaitFrame(milliseconds(100));
        if (!frame) answer = frame.error();
    }
    ASSERT_EQ(answer, hal::Error::kDisconnected);
    EXPECT_EQ(camera.value()->WaitFrame(milliseconds(100)).error(), hal::Error::kDisconnected);
    EXPECT_TRUE(camera.value()->Reopen().ok());
    EXPECT_EQ(camera.value()->counts().reopened, 1U);
}

TEST_F(LibcameraTest, ACameraInUseIsRefusedInWords) {
    const auto first = OpenLibcamera(Options());
    ASSERT_TRUE(first.ok()) << first.error();
    const auto second = OpenLibcamera(Options());
    ASSERT_FALSE(second.ok());
    EXPECT_THAT(second.error(), HasSubstr("cannot be acquired"));
}

}  // namespace
}  // namespace hitchview::drivers
