#include <gtest/gtest.h>

#include "tests/device/camera_follower.hpp"
#include "tests/device/vivid.hpp"
#include "tests/support/temporary_folder.hpp"

namespace hitchview::drivers {
namespace {

using hal::Error;
using std::chrono::milliseconds;
using tests::CameraFollower;
using tests::Vivid;

constexpr milliseconds kLongestRecovery{1000};

class V4l2SourceTest : public testing::Test {
 protected:
    void SetUp() override {
        if (!tests::VividIsThere()) GTEST_SKIP() << "this kernel has no virtual cameras (vivid)";
        vivid_ = std::make_unique<Vivid>(tests::VividOptions{.input = tests::VividInput::kHdmi});
        ASSERT_TRUE(vivid_->loaded());
    }

    void Start() {
        auto options = tests::VividCamera(0);
        options.wish = {{1280, 720}, 60, "uyvy"};
        auto camera = V4l2Camera::Open(options);
        ASSERT_TRUE(camera.ok()) << camera.error();
        camera_ = std::move(camera.value());
        follower_ = std::make_unique<CameraFollower>(*camera_);
        ASSERT_TRUE(follower_->AwaitFrames(10));
    }

    /// The source changes to one of the sizes that it has a menu of.
    static void Select(int size) {
        ASSERT_TRUE(Vivid::Set(0, "dv_timings_signal_mode", tests::kSelectedSignal));
        ASSERT_TRUE(Vivid::Set(0, "dv_timings", size));
    }

    /// As after a fault that has just ended.
    void ExpectFramesSoon() const {
        const auto end = CameraFollower::Clock::now() + kLongestRecovery;
        EXPECT_TRUE(follower_->AwaitFrames(3));
        EXPECT_LT(CameraFollower::Clock::now(), end);
        EXPECT_EQ(follower_->heap_calls(), 0U);
    }

    std::unique_ptr<Vivid> vivid_;
    std::unique_ptr<V4l2Camera> camera_;
    std::unique_ptr<CameraFollower> follower_;
};

TEST_F(V4l2SourceTest, ASignalThatIsLostAndComesBackIsFollowed) {
    ASSERT_NO_FATAL_FAILURE(Start());
    ASSERT_TRUE(Vivid::Set(0, "dv_timings_signal_mode", tests::kNoSignal));
    EXPECT_TRUE(CameraFollower::Await([&] { return follower_->refusals(Error::kNotFound) > 1; }));
    EXPECT_EQ(follower_->answers(Error::kDisconnected) > 0, true);
    ASSERT_TRUE(Vivid::Set(0, "dv_timings_signal_mode", tests::kCurrentSignal));
    ExpectFramesSoon();
}

TEST_F(V4l2SourceTest, AnotherSizeThatTheDeviceScalesToOursGoesOnByItself) {
    ASSERT_NO_FATAL_FAILURE(Start());
    ASSERT_NO_FATAL_FAILURE(Select(tests::k640x480p59));
    EXPECT_TRUE(CameraFollower::Await([&] { return camera_->counts().reopened > 0; }));
    ExpectFramesSoon();
    EXPECT_EQ(follower_->answers(Error::kDisconnected), 0);
}

TEST_F(V4l2SourceTest, AnotherSizeIsRefusedUntilItIsOursAgain) {
    for (const char* ability : {"scaler", "cropping", "composing"}) {
        ASSERT_TRUE(Vivid::Set(0, std::string("enable_capture_") + ability, 0));
    }
    ASSERT_NO_FATAL_FAILURE(Start());
    ASSERT_NO_FATAL_FAILURE(Select(tests::k640x480p59));
    EXPECT_TRUE(
        CameraFollower::Await([&] { return follower_->refusals(Error::kUnsupported) > 1; }));
    ASSERT_NO_FATAL_FAILURE(Select(tests::k1280x720p60));
    ExpectFramesSoon();
}

/// Without its module a camera is not there at all.
TEST(V4l2UnplugTest, AFrameOutlivesTheDriverAndTheCameraComesBack) {
    if (!tests::VividIsThere()) GTEST_SKIP() << "this kernel has no virtual cameras (vivid)";
    Vivid vivid({});
    ASSERT_TRUE(vivid.loaded());
    const tests::TemporaryFolder links;
    std::filesystem::create_symlink("/dev/video0", links / "rear");
    auto options = tests::VividCamera(0);
    options.path = links / "rear";
    auto opened = V4l2Camera::Open(options);
    ASSERT_TRUE(opened.ok()) << opened.error();
    V4l2Camera& camera = *opened.value();
    const auto held = camera.WaitFrame(milliseconds(1000));
    ASSERT_TRUE(held.ok());
    const std::uint8_t pixel = held.value().view().planes[0].data[0];

    ASSERT_TRUE(Vivid::Set(0, "disconnect", 1));
    EXPECT_EQ(camera.WaitFrame(milliseconds(1000)).error(), Error::kDisconnected);
    ASSERT_TRUE(vivid.Unload());
    EXPECT_EQ(camera.Reopen().error(), Error::kNotFound);
    EXPECT_EQ(held.value().view().planes[0].data[0], pixel);

    ASSERT_TRUE(vivid.Load());
    ASSERT_TRUE(CameraFollower::Await([&] { return camera.Reopen().ok(); }));
    EXPECT_TRUE(camera.WaitFrame(milliseconds(1000)).ok());
    EXPECT_EQ(held.value().view().planes[0].data[0], pixel);
    EXPECT_EQ(camera.counts().reopened, 1U);
}

}  // namespace
}  // namespace hitchview::drivers
