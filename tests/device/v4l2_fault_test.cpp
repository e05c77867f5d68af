#include <gtest/gtest.h>

#include <vector>

#include "tests/device/camera_follower.hpp"
#include "tests/device/vivid.hpp"

namespace hitchview::drivers {
namespace {

using hal::Error;
using std::chrono::milliseconds;
using tests::CameraFollower;
using tests::Vivid;
using tests::VividCamera;

constexpr milliseconds kLongestRecovery{1000};

/// Two cameras: a fault befalls the first, the second must not notice.
class V4l2FaultTest : public testing::Test {
 protected:
    void SetUp() override {
        if (!tests::VividIsThere()) GTEST_SKIP() << "this kernel has no virtual cameras (vivid)";
        vivid_ = std::make_unique<Vivid>(tests::VividOptions{.cameras = 2});
        ASSERT_TRUE(vivid_->loaded());
        for (int i = 0; i < 2; ++i) {
            auto options = VividCamera(i);
            options.wish.size = {640, 360};
            auto camera = V4l2Camera::Open(options);
            ASSERT_TRUE(camera.ok()) << camera.error();
            cameras_.push_back(std::move(camera.value()));
            followers_.push_back(std::make_unique<CameraFollower>(*cameras_.back()));
        }
        ASSERT_TRUE(faulty().AwaitFrames(5) && sound().AwaitFrames(5));
    }

    void TearDown() override {
        if (followers_.size() < 2) return;
        EXPECT_EQ(sound_camera().counts().reopened, 0U);
        EXPECT_EQ(sound_camera().counts().corrupted, 0U);
        EXPECT_EQ(sound().answers(Error::kDisconnected), 0);
        EXPECT_TRUE(sound().AwaitFrames(5));
        EXPECT_TRUE(sound().in_order() && faulty().in_order());
        EXPECT_EQ(sound().heap_calls() + faulty().heap_calls(), 0U);
        std::printf("longest silence: faulty %ld ms, sound %ld ms\n",
                    static_cast<long>(faulty().longest_silence().count()),
                    static_cast<long>(sound().longest_silence().count()));
    }

    /// The first camera is lost and comes back in time, without being told anything else.
    void ExpectRecovery(std::uint64_t times) {
        EXPECT_TRUE(CameraFollower::Await([&] { return camera().counts().reopened == times; }));
        EXPECT_TRUE(faulty().AwaitFrames(10));
        EXPECT_EQ(camera().counts().reopened, times);
        EXPECT_LT(faulty().longest_silence(), kLongestRecovery);
    }

    CameraFollower& faulty() { return *followers_[0]; }
    CameraFollower& sound() { return *followers_[1]; }
    V4l2Camera& camera() { return *cameras_[0]; }
    V4l2Camera& sound_camera() { return *cameras_[1]; }

    std::unique_ptr<Vivid> vivid_;
    std::vector<std::unique_ptr<V4l2Camera>> cameras_;
    std::vector<std::unique_ptr<CameraFollower>> followers_;
};

TEST_F(V4l2FaultTest, ADeviceThatIsPulledOutAndComesBackIsHadAgain) {
    ASSERT_TRUE(Vivid::Set(0, "disconnect", 1));
    ExpectRecovery(1);
    ASSERT_TRUE(Vivid::Set(0, "disconnect", 1));
    ExpectRecovery(2);
}

TEST_F(V4l2FaultTest, AFatalErrorWhileStreamingIsRecoveredFrom) {
    ASSERT_TRUE(Vivid::Set(0, "inject_fatal_streaming_error", 1));
    ExpectRecovery(1);
}

TEST_F(V4l2FaultTest, ADeviceThatDoesNotStreamAtOnceIsTriedAgain) {
    ASSERT_TRUE(Vivid::Set(0, "inject_vidioc_streamon_error", 1));
    ASSERT_TRUE(Vivid::Set(0, "inject_fatal_streaming_error", 1));
    ExpectRecovery(1);
    EXPECT_EQ(faulty().refusals(Error::kFailed), 1);
}

TEST_F(V4l2FaultTest, ADeviceThatHasNoBuffersAtOnceIsTriedAgain) {
    ASSERT_TRUE(Vivid::Set(0, "inject_vidioc_reqbufs_error", 1));
    ASSERT_TRUE(Vivid::Set(0, "inject_fatal_streaming_error", 1));
    ExpectRecovery(1);
    EXPECT_EQ(faulty().refusals(Error::kFailed), 1);
}

TEST_F(V4l2FaultTest, ABufferThatIsRefusedIsOfferedAgainAndNothingIsLost) {
    ASSERT_TRUE(Vivid::Set(0, "inject_vidioc_qbuf_error", 1));
    EXPECT_TRUE(faulty().AwaitFrames(20));
    EXPECT_EQ(faulty().answers(Error::kDisconnected), 0);
    EXPECT_EQ(camera().counts().reopened, 0U);
}

TEST_F(V4l2FaultTest, AFrameThatTheDriverMarksIsCorruptedAndCountedOnce) {
    ASSERT_TRUE(Vivid::Set(0, "inject_v4l2_buf_flag_error", 1));
    EXPECT_TRUE(CameraFollower::Await([&] { return camera().counts().corrupted == 1; }));
    EXPECT_TRUE(faulty().AwaitFrames(5));
    EXPECT_EQ(camera().counts().corrupted, 1U);
    EXPECT_EQ(faulty().answers(Error::kCorrupted), 1);
    EXPECT_EQ(camera().counts().reopened, 0U);
}

TEST_F(V4l2FaultTest, DroppedFramesAreCountedAsLost) {
    const std::uint64_t delivered = camera().counts().delivered;
    const std::uint64_t lost = camera().counts().lost;
    ASSERT_TRUE(Vivid::Set(0, "percentage_of_dropped_buffers", 50));
    EXPECT_TRUE(faulty().AwaitFrames(40));
    ASSERT_TRUE(Vivid::Set(0, "percentage_of_dropped_buffers", 0));
    const auto more_lost = static_cast<double>(camera().counts().lost - lost);
    const auto more_delivered = static_cast<double>(camera().counts().delivered - delivered);
    EXPECT_NEAR(more_lost / (more_lost + more_delivered), 0.5, 0.25);
}

TEST_F(V4l2FaultTest, ADeviceThatFallsSilentIsGivenUpAndHadAgain) {
    ASSERT_TRUE(Vivid::Set(0, "percentage_of_dropped_buffers", 100));
    EXPECT_TRUE(CameraFollower::Await([&] { return camera().counts().reopened > 0; }));
    EXPECT_GT(faulty().answers(Error::kDisconnected), 0);
    const auto end = CameraFollower::Clock::now() + kLongestRecovery;
    ASSERT_TRUE(Vivid::Set(0, "percentage_of_dropped_buffers", 0));
    EXPECT_TRUE(faulty().AwaitFrames(3));
    EXPECT_LT(CameraFollower::Clock::now(), end);
}

TEST_F(V4l2FaultTest, SequenceNumbersMayWrap) {
    const std::uint64_t lost = camera().counts().lost;
    ASSERT_TRUE(Vivid::Set(0, "wrap_sequence_number", 1));
    // The number jumps to 128 before the wrap once the stream starts anew.
    ASSERT_TRUE(Vivid::Set(0, "inject_fatal_streaming_error", 1));
    ExpectRecovery(1);
    EXPECT_TRUE(faulty().AwaitFrames(75) && faulty().AwaitFrames(75));
    EXPECT_LT(camera().counts().lost - lost, 100U);
}

}  // namespace
}  // namespace hitchview::drivers
