#include <gtest/gtest.h>

#include <memory>
#include <thread>
#include <vector>

#include "drivers/v4l2_camera.hpp"
#include "drivers/v4l2_settings.hpp"
#include "tests/support/fake_v4l2_kernel.hpp"
#include "tests/support/heap_calls.hpp"
#include "tests/support/jpeg_picture.hpp"

namespace hitchview::drivers {
namespace {

using hal::Error;
using std::chrono::microseconds;
using std::chrono::milliseconds;
using tests::Bytes;

constexpr std::uint32_t kStampFlags =
    V4L2_BUF_FLAG_TIMESTAMP_MONOTONIC | V4L2_BUF_FLAG_TSTAMP_SRC_SOE;

class V4l2CameraTest : public testing::Test {
 protected:
    V4l2CameraTest() {
        options_.name = "fake";
        options_.path = "/dev/video7";
        options_.wish = {{64, 48}, 100, "best"};
        options_.buffers = 3;
        options_.silence_periods = 2;
    }

    /// What the camera will deliver after it was opened.
    void Script(std::uint32_t first, int frames, const Bytes& bytes = Bytes(64 * 48, 9)) {
        for (int i = 0; i < frames; ++i) {
            const std::uint32_t sequence = first + static_cast<std::uint32_t>(i);
            // Not even the first one has the stamp 0, which is none.
            const auto stamp = std::max(microseconds(1), microseconds(10'000 * sequence));
            kernel_.script.push_back({sequence, stamp, bytes, flags_});
        }
    }

    /// Opened, and past what came before the first call.
    V4l2Camera& Open() {
        auto camera = V4l2Camera::Open(options_, kernel_);
        EXPECT_TRUE(camera.ok()) << camera.error();
        camera_ = std::move(camera.value());
        EXPECT_EQ(camera_->WaitFrame(milliseconds(1)).error(), Error::kTimeout);
        return *camera_;
    }

    Error Answer() { return camera_->WaitFrame(std::chrono::seconds(10)).error(); }

    tests::FakeV4l2Kernel kernel_;
    V4l2CameraOptions options_;
    std::uint32_t flags_ = kStampFlags;
    std::unique_ptr<V4l2Camera> camera_;
};

TEST_F(V4l2CameraTest, LendsTheDriversOwnBuffers) {
    V4l2Camera& camera = Open();
    Script(5, 1);
    const auto frame = camera.WaitFrame(milliseconds(100));
    ASSERT_TRUE(frame.ok());
    const hal::FrameView& view = frame.value().view();
    EXPECT_EQ(view.planes[0].data[0], 9);
    EXPECT_GE(camera.FindDmabuf(view.planes[0]).file, 0);
    EXPECT_EQ(view.header.captured_at, milliseconds(50));
}

TEST_F(V4l2CameraTest, WhatCameBeforeTheFirstCallIsDropped) {
    Script(0, 3);
    auto camera = V4l2Camera::Open(options_, kernel_);
    ASSERT_TRUE(camera.ok()) << camera.error();
    EXPECT_EQ((*camera)->WaitFrame(milliseconds(1)).error(), Error::kTimeout);
    EXPECT_EQ((*camera)->counts().delivered, 0U);
}

TEST_F(V4l2CameraTest, WorksWithoutDmabuf) {
    kernel_.exports = false;
    V4l2Camera& camera = Open();
    EXPECT_FALSE(camera.facts().dmabuf);
    EXPECT_EQ(kernel_.refused[VIDIOC_EXPBUF], 1);
    Script(0, 1);
    const auto frame = camera.WaitFrame(milliseconds(100));
    ASSERT_TRUE(frame.ok());
    EXPECT_EQ(camera.FindDmabuf(frame.value().view().planes[0]).file, -1);
}

TEST_F(V4l2CameraTest, WithAllBuffersLentItWaitsAndIsWokenByAReturn) {
    V4l2Camera& camera = Open();
    Script(0, 4);
    std::vector<hal::FrameLease> held;
    for (int i = 0; i < 3; ++i) {
        held.push_back(std::move(camera.WaitFrame(milliseconds(100)).value()));
    }
    // Longer than its silence would be borne: nobody is to blame.
    EXPECT_EQ(camera.WaitFrame(milliseconds(100)).error(), Error::kTimeout);
    EXPECT_EQ(kernel_.stream_starts, 1);
    EXPECT_EQ(camera.pool().low_water, 0);
    std::thread returning([&] {
        std::this_thread::sleep_for(milliseconds(20));
        held.clear();
    });
    EXPECT_TRUE(camera.WaitFrame(std::chrono::seconds(10)).ok());
    returning.join();
}

TEST_F(V4l2CameraTest, SilenceRestartsTheStreamOnceAndThenEndsIt) {
    Open();
    EXPECT_EQ(Answer(), Error::kDisconnected);
    EXPECT_EQ(kernel_.stream_starts, 2);
    EXPECT_EQ(camera_->loss(), hal::CameraLoss::kSilent);
    EXPECT_EQ(Answer(), Error::kDisconnected);
    EXPECT_TRUE(camera_->Reopen().ok());
    EXPECT_EQ(camera_->counts().reopened, 1U);
    Script(0, 1);
    EXPECT_TRUE(camera_->WaitFrame(milliseconds(100)).ok());
}

TEST_F(V4l2CameraTest, AnErrorOfPollThatTheDeviceDoesNotConfirmCostsNothing) {
    V4l2Camera& camera = Open();
    kernel_.poll_errors = 3;
    EXPECT_EQ(camera.WaitFrame(milliseconds(1)).error(), Error::kTimeout);
    kernel_.poll_errors = 1;
    Script(0, 1);
    EXPECT_TRUE(camera.WaitFrame(milliseconds(100)).ok());
    EXPECT_EQ(camera.counts().lost, 0U);
}

TEST_F(V4l2CameraTest, ADeviceThatFailsIsLostAtOnceAndSaysWhy) {
    V4l2Camera& camera = Open();
    for (const auto& [error, loss] : {std::pair{EIO, hal::CameraLoss::kIoError},
                                      std::pair{ENODEV, hal::CameraLoss::kDisconnected}}) {
        kernel_.failure = error;
        EXPECT_EQ(Answer(), Error::kDisconnected);
        EXPECT_EQ(camera.loss(), loss);
        kernel_.failure = 0;
        EXPECT_TRUE(camera.Reopen().ok());
    }
}

TEST(V4l2TimingsTest, SignalsThatDifferInTheirBlankingAloneAreFollowed) {
    constexpr std::uint32_t kBlankingAt60Hz = 110;
    constexpr std::uint32_t kBlankingAt30Hz = 1760;
    tests::FakeV4l2Kernel kernel;
    kernel.timings.bt.width = 1280;
    kernel.timings.bt.height = 720;
    kernel.timings.bt.pixelclock = 74'250'000;
    kernel.timings.bt.hfrontporch = kBlankingAt60Hz;
    kernel.signal = kernel.timings;
    kernel.signal.bt.hfrontporch = kBlankingAt30Hz;
    V4l2Device device(kernel);
    ASSERT_TRUE(device.Open("/dev/video7"));
    EXPECT_TRUE(FollowTimings(device));
    EXPECT_EQ(kernel.timings.bt.hfrontporch, kBlankingAt30Hz);
}

TEST_F(V4l2CameraTest, ADeviceThatPromisesFramesAndGivesNoneIsSilentToo) {
    Open();
    kernel_.poll_lies = true;
    EXPECT_EQ(Answer(), Error::kDisconnected);
    EXPECT_EQ(kernel_.stream_starts, 2);
}

TEST_F(V4l2CameraTest, TimeInWhichNobodyAsksIsNoSilence) {
    options_.silence_periods = 20;  // 200 ms
    auto camera = V4l2Camera::Open(options_, kernel_);
    ASSERT_TRUE(camera.ok()) << camera.error();
    std::this_thread::sleep_for(milliseconds(250));
    EXPECT_EQ((*camera)->WaitFrame(milliseconds(1)).error(), Error::kTimeout);
    EXPECT_EQ(kernel_.stream_starts, 1);
}

TEST_F(V4l2CameraTest, AFrameHeldThroughAReopenKeepsItsMemory) {
    V4l2Camera& camera = Open();
    Script(0, 1);
    auto frame = camera.WaitFrame(milliseconds(100));
    ASSERT_TRUE(frame.ok());
    EXPECT_EQ(Answer(), Error::kDisconnected);
    EXPECT_EQ(kernel_.mapped, 1);
    EXPECT_TRUE(camera.Reopen().ok());
    EXPECT_EQ(kernel_.mapped, 4);
    EXPECT_EQ(frame.value().view().planes[0].data[0], 9);
    frame.value().Release();
    EXPECT_EQ(camera.WaitFrame(milliseconds(1)).error(), Error::kTimeout);
    EXPECT_EQ(kernel_.mapped, 3);
}

TEST_F(V4l2CameraTest, AnotherDeviceOnItsPathIsRefused) {
    V4l2Camera& camera = Open();
    EXPECT_EQ(Answer(), Error::kDisconnected);
    kernel_.there = false;
    EXPECT_EQ(camera.Reopen().error(), Error::kNotFound);
    kernel_.there = true;
    kernel_.bus = "usb-2";  // the number has passed to the camera on the next port
    EXPECT_EQ(camera.Reopen().error(), Error::kUnsupported);
    kernel_.bus = "usb-1";
    EXPECT_TRUE(camera.Reopen().ok());
}

TEST_F(V4l2CameraTest, ANamedCameraMayMoveButNotChange) {
    options_.path = "/dev/hitchview/rear";
    V4l2Camera& camera = Open();
    EXPECT_EQ(Answer(), Error::kDisconnected);
    kernel_.card = "Other";
    EXPECT_EQ(camera.Reopen().error(), Error::kUnsupported);
    kernel_.card = "Fake";
    kernel_.bus = "usb-2";
    EXPECT_TRUE(camera.Reopen().ok());
}

TEST_F(V4l2CameraTest, ReopeningTakesNoMemory) {
    if (!tests::kHeapCallsAreCounted) GTEST_SKIP() << "a sanitizer owns malloc";
    V4l2Camera& camera = Open();
    EXPECT_EQ(Answer(), Error::kDisconnected);
    kernel_.there = false;
    const std::uint64_t before = tests::HeapCallsOfThisThread();
    EXPECT_EQ(camera.Reopen().error(), Error::kNotFound);
    EXPECT_EQ(tests::HeapCallsOfThisThread(), before);
}

TEST_F(V4l2CameraTest, AnEndOfFrameStampIsMovedByTheExposure) {
    flags_ = V4L2_BUF_FLAG_TIMESTAMP_MONOTONIC;
    kernel_.controls[V4L2_CID_EXPOSURE_ABSOLUTE] = 40;  // 4 ms
    V4l2Camera& camera = Open();
    Script(5, 1);
    const auto frame = camera.WaitFrame(milliseconds(100));
    ASSERT_TRUE(frame.ok());
    EXPECT_EQ(frame.value().view().header.captured_at, milliseconds(46));
}

TEST_F(V4l2CameraTest, WithoutAMonotonicStampTheTimeOfDequeueingCounts) {
    flags_ = V4L2_BUF_FLAG_TIMESTAMP_UNKNOWN;
    V4l2Camera& camera = Open();
    EXPECT_EQ(camera.facts().stamps, V4l2StampSource::kDequeue);
    Script(5, 1);
    const hal::Instant before = std::chrono::steady_clock::now().time_since_epoch();
    const auto frame = camera.WaitFrame(milliseconds(100));
    ASSERT_TRUE(frame.ok());
    EXPECT_GE(frame.value().view().header.captured_at, before - milliseconds(10));
}

TEST_F(V4l2CameraTest, WithoutAnyStampTheTimeOfDequeueingCounts) {
    V4l2Camera& camera = Open();
    for (std::uint32_t i = 0; i < 2; ++i) {
        kernel_.script.push_back({i, {}, Bytes(64 * 48, 9), flags_});
        const hal::Instant before = std::chrono::steady_clock::now().time_since_epoch();
        const auto frame = camera.WaitFrame(milliseconds(100));
        ASSERT_TRUE(frame.ok());
        EXPECT_GE(frame.value().view().header.captured_at, before - milliseconds(10));
    }
}

TEST_F(V4l2CameraTest, AStampAheadOfTheClockIsReplacedByTheMomentOfDequeueing) {
    V4l2Camera& camera = Open();
    const auto now = [] { return std::chrono::steady_clock::now().time_since_epoch(); };
    const auto ahead = std::chrono::duration_cast<microseconds>(now()) + std::chrono::hours(1);
    kernel_.script.push_back({0, ahead, Bytes(64 * 48), flags_});
    const auto frame = camera.WaitFrame(milliseconds(100));
    ASSERT_TRUE(frame.ok());
    EXPECT_LE(frame.value().view().header.captured_at, now());
}

TEST_F(V4l2CameraTest, ShortAndMarkedFramesAreCorrupted) {
    V4l2Camera& camera = Open();
    Script(0, 1, Bytes(64 * 48 - 1));
    EXPECT_EQ(Answer(), Error::kCorrupted);
    flags_ |= V4L2_BUF_FLAG_ERROR;
    Script(1, 1);
    EXPECT_EQ(Answer(), Error::kCorrupted);
    EXPECT_EQ(camera.counts().corrupted, 2U);
    EXPECT_EQ(camera.counts().lost, 0U);
}

TEST_F(V4l2CameraTest, WhatTheDriverChangedIsToldInWords) {
    kernel_.granted_width = 32;
    EXPECT_EQ(V4l2Camera::Open(options_, kernel_).error(),
              "/dev/video7: wanted GREY 64x48 at 100 Hz, got GREY 32x48 at 100 Hz; offered: GREY "
              "64x48 at 100 Hz");
}

TEST_F(V4l2CameraTest, LinesThatRunIntoEachOtherAreRefused) {
    kernel_.granted_line_bytes = 63;
    const auto refused = V4l2Camera::Open(options_, kernel_);
    ASSERT_FALSE(refused.ok());
    EXPECT_NE(refused.error().find("got GREY 64x48 at 100 Hz in lines of 63 bytes"),
              std::string::npos)
        << refused.error();
    kernel_.granted_line_bytes = 64;
    V4l2Camera& camera = Open();
    EXPECT_EQ(Answer(), Error::kDisconnected);
    kernel_.granted_line_bytes = 0xffffffff;  // -1
    EXPECT_EQ(camera.Reopen().error(), Error::kUnsupported);
}

TEST_F(V4l2CameraTest, ListsThatNeverEndAreCutOff) {
    kernel_.lists_end = false;
    kernel_.controls[V4L2_CID_BRIGHTNESS] = 1;
    kernel_.control_type = V4L2_CTRL_TYPE_MENU;
    options_.controls = {{"nothing", "1"}};
    EXPECT_NE(V4l2Camera::Open(options_, kernel_).error().find("control nothing is not there"),
              std::string::npos);
}

TEST_F(V4l2CameraTest, ADeviceWithoutARateSettingIsTakenAtItsWord) {
    kernel_.has_rate = false;
    EXPECT_FALSE(Open().facts().granted.rate_is_set);
    EXPECT_EQ(kernel_.refused[VIDIOC_S_PARM], 0);
}

class V4l2MotionJpegTest : public V4l2CameraTest {
 protected:
    V4l2MotionJpegTest() { kernel_.fourcc = V4L2_PIX_FMT_MJPEG; }

    const Bytes jpeg_ = tests::JpegPicture(64, 48, TJSAMP_422, 1);
};

TEST_F(V4l2MotionJpegTest, IsDecodedInTheCallersThreadWithoutTheHeap) {
    V4l2Camera& camera = Open();
    EXPECT_EQ(camera.format().pixel_format, hal::PixelFormat::kNv12);
    EXPECT_EQ(camera.format().range, hal::Range::kFull);
    Script(0, 1, jpeg_);
    const std::uint64_t before = tests::HeapCallsOfThisThread();
    const auto frame = camera.WaitFrame(milliseconds(100));
    const std::uint64_t calls = tests::HeapCallsOfThisThread() - before;
    EXPECT_EQ(calls, 0U);
    ASSERT_TRUE(frame.ok());
    const auto luma = tests::ReferencePlanes(jpeg_).samples[0];
    const std::uint8_t* const decoded = frame.value().view().planes[0].data;
    EXPECT_TRUE(std::equal(luma.begin(), luma.end(), decoded));
}

TEST_F(V4l2MotionJpegTest, ADamagedPictureIsCorruptedAndTheNextIsGood) {
    V4l2Camera& camera = Open();
    Script(0, 1, Bytes(jpeg_.begin(), jpeg_.begin() + 300));
    Script(1, 1, jpeg_);
    EXPECT_EQ(Answer(), Error::kCorrupted);
    EXPECT_TRUE(camera.WaitFrame(milliseconds(100)).ok());
    EXPECT_EQ(camera.counts().corrupted, 1U);
}

TEST_F(V4l2MotionJpegTest, WithoutMemoryToDecodeIntoFramesAreLost) {
    V4l2Camera& camera = Open();
    Script(0, 5, jpeg_);
    std::vector<hal::FrameLease> held;
    for (int i = 0; i < 3; ++i) {
        held.push_back(std::move(camera.WaitFrame(milliseconds(100)).value()));
    }
    EXPECT_EQ(camera.WaitFrame(milliseconds(5)).error(), Error::kTimeout);
    EXPECT_EQ(camera.counts().lost, 2U);
    held.clear();
    Script(5, 1, jpeg_);
    const auto frame = camera.WaitFrame(milliseconds(100));
    ASSERT_TRUE(frame.ok());
    EXPECT_EQ(frame.value().view().header.sequence, 5U);
}

}  // namespace
}  // namespace hitchview::drivers
