#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <array>

#include "drivers/v4l2_camera.hpp"
#include "tests/support/fake_v4l2_kernel.hpp"
#include "tests/support/heap_calls.hpp"
#include "tests/support/jpeg_picture.hpp"

// A camera that is not there when the program starts.
namespace hitchview::drivers {
namespace {

using hal::CameraLoss;
using hal::Error;
using std::chrono::microseconds;
using std::chrono::milliseconds;
using testing::HasSubstr;
using tests::Bytes;

V4l2CameraOptions Options(const char* path) {
    V4l2CameraOptions options;
    options.name = "fake";
    options.path = path;
    options.wish = {{64, 48}, 100, "best"};
    options.buffers = 3;
    return options;
}

class V4l2AbsenceTest : public testing::Test {
 protected:
    V4l2AbsenceTest() { kernel_.there = false; }

    /// The camera that is awaited; with `there_`, if it was opened, beside it.
    V4l2Camera& Await() {
        const auto opened = V4l2Camera::TryOpen(options_, kernel_);
        EXPECT_FALSE(opened.ok());
        EXPECT_FALSE(opened.error().is_wish_wrong);
        std::vector<const V4l2Camera*> others;
        if (other_) others.push_back(other_.get());
        camera_ = V4l2Camera::Await(options_, opened.error().failure, others, kernel_);
        return *camera_;
    }
    void OpenOther(const V4l2CameraOptions& options) {
        auto opened = V4l2Camera::Open(options, other_kernel_);
        ASSERT_TRUE(opened) << opened.error();
        other_ = std::move(*opened);
    }
    void Script(const Bytes& bytes) {
        kernel_.script.push_back(
            {0, microseconds(10), bytes,
             V4L2_BUF_FLAG_TIMESTAMP_MONOTONIC | V4L2_BUF_FLAG_TSTAMP_SRC_SOE});
    }

    tests::FakeV4l2Kernel kernel_;
    tests::FakeV4l2Kernel other_kernel_;
    V4l2CameraOptions options_ = Options("/dev/video7");
    std::unique_ptr<V4l2Camera> other_;
    std::unique_ptr<V4l2Camera> camera_;
};

TEST_F(V4l2AbsenceTest, ItIsLostUntilItComesAndThenGivesFrames) {
    options_.wish.format = "grey";
    V4l2Camera& camera = Await();
    EXPECT_EQ(camera.loss(), CameraLoss::kDisconnected);
    EXPECT_EQ(camera.WaitFrame(milliseconds(10)).error(), Error::kDisconnected);
    EXPECT_EQ(camera.Reopen().error(), Error::kNotFound);
    EXPECT_EQ(camera.counts().reopened, 0U);
    kernel_.there = true;
    ASSERT_TRUE(camera.Reopen().ok());
    Script(Bytes(64 * 48, 9));
    const auto frame = camera.WaitFrame(milliseconds(100));
    ASSERT_TRUE(frame.ok());
    EXPECT_EQ(frame.value().view().planes[0].data[0], 9);
    EXPECT_EQ(frame.value().view().format, camera.format());
    EXPECT_EQ(camera.counts().reopened, 1U);
}

TEST_F(V4l2AbsenceTest, TheReasonOfItsAbsenceIsTold) {
    const std::array reasons{std::tuple{ENOENT, CameraLoss::kDisconnected, "open: No such file"},
                             std::tuple{EBUSY, CameraLoss::kBusy, "open: Device or resource busy"},
                             std::tuple{EACCES, CameraLoss::kForbidden, "open: Permission denied"},
                             std::tuple{EIO, CameraLoss::kIoError, "open: Input/output error"}};
    for (const auto& [error, loss, words] : reasons) {
        kernel_.absence = error;
        EXPECT_EQ(Await().loss(), loss);
        EXPECT_THAT(V4l2Camera::TryOpen(options_, kernel_).error().words,
                    HasSubstr(std::string("/dev/video7: ") + words));
    }
}

TEST_F(V4l2AbsenceTest, ADeviceThatGivesAnotherFormatIsAwaitedToo) {
    kernel_.there = true;
    kernel_.granted_width = 32;
    EXPECT_EQ(Await().loss(), CameraLoss::kOtherFormat);
}

TEST_F(V4l2AbsenceTest, WhatTheRigFileAsksForWronglyIsNotAwaited) {
    kernel_.there = true;
    V4l2CameraOptions control = options_;
    control.controls = {{"nothing", "1"}};
    V4l2CameraOptions rotation = options_;
    rotation.orientation.rotation_deg = 180;
    V4l2CameraOptions format = options_;
    format.wish.format = "no such";
    for (const V4l2CameraOptions& wrong : {control, rotation, format}) {
        const auto opened = V4l2Camera::TryOpen(wrong, kernel_);
        ASSERT_FALSE(opened.ok());
        EXPECT_TRUE(opened.error().is_wish_wrong) << opened.error().words;
    }
}

TEST_F(V4l2AbsenceTest, ItIsExpectedToGiveWhatAnotherCameraGives) {
    for (const std::uint32_t fourcc : {V4L2_PIX_FMT_UYVY, V4L2_PIX_FMT_YUYV, V4L2_PIX_FMT_GREY}) {
        other_kernel_.fourcc = fourcc;
        OpenOther(Options("/dev/video0"));
        kernel_.there = false;
        V4l2Camera& camera = Await();
        EXPECT_EQ(camera.format(), other_->format());
        kernel_.there = true;
        kernel_.fourcc = fourcc;
        EXPECT_TRUE(camera.Reopen().ok());
    }
}

TEST_F(V4l2AbsenceTest, AnotherFormatIsRefusedEachTimeAndTheExpectedOneTaken) {
    other_kernel_.fourcc = kernel_.fourcc = V4L2_PIX_FMT_UYVY;
    OpenOther(Options("/dev/video0"));
    V4l2Camera& camera = Await();
    kernel_.there = true;
    kernel_.fourcc = V4L2_PIX_FMT_GREY;
    EXPECT_EQ(camera.Reopen().error(), Error::kUnsupported);
    kernel_.card = "Another";  // what was refused is not the camera that is remembered
    EXPECT_EQ(camera.Reopen().error(), Error::kUnsupported);
    kernel_.fourcc = V4L2_PIX_FMT_UYVY;
    EXPECT_TRUE(camera.Reopen().ok());
}

TEST_F(V4l2AbsenceTest, OnceItWasThereNoOtherDeviceIsTaken) {
    V4l2Camera& camera = [this]() -> V4l2Camera& {
        options_.wish.format = "grey";
        return Await();
    }();
    kernel_.there = true;
    ASSERT_TRUE(camera.Reopen().ok());
    kernel_.failure = ENODEV;
    EXPECT_EQ(camera.WaitFrame(std::chrono::seconds(10)).error(), Error::kDisconnected);
    kernel_.failure = 0;
    kernel_.bus = "usb-2";
    EXPECT_EQ(camera.Reopen().error(), Error::kUnsupported);
    kernel_.bus = "usb-1";
    EXPECT_TRUE(camera.Reopen().ok());
}

TEST_F(V4l2AbsenceTest, ItsControlsAreSetAsOthersAreAndItsMirrorsAsItIsMounted) {
    const V4l2ControlWish brightness{std::to_string(V4L2_CID_BRIGHTNESS), "7"};
    other_kernel_.controls = {{V4L2_CID_BRIGHTNESS, 0}, {V4L2_CID_HFLIP, 5}};
    V4l2CameraOptions other = Options("/dev/video0");
    other.controls = {brightness};
    OpenOther(other);
    options_.controls = {brightness};
    options_.orientation.rotation_deg = 180;
    V4l2Camera& camera = Await();
    kernel_.there = true;
    kernel_.controls = {{V4L2_CID_BRIGHTNESS, 0}, {V4L2_CID_HFLIP, 0}, {V4L2_CID_VFLIP, 0}};
    EXPECT_TRUE(camera.Reopen().ok());
    EXPECT_EQ(kernel_.controls.at(V4L2_CID_BRIGHTNESS), 7);
    EXPECT_EQ(kernel_.controls.at(V4L2_CID_HFLIP), 1);
    EXPECT_EQ(kernel_.controls.at(V4L2_CID_VFLIP), 1);
    EXPECT_EQ(other_kernel_.controls.at(V4L2_CID_HFLIP), 0);
}

TEST_F(V4l2AbsenceTest, WithoutAMirrorThatItNeedsItIsRefused) {
    options_.wish.format = "grey";
    options_.orientation.vertical_flip = true;
    V4l2Camera& camera = Await();
    kernel_.there = true;
    EXPECT_EQ(camera.Reopen().error(), Error::kUnsupported);
}

TEST_F(V4l2AbsenceTest, ControlsThatNoOtherCameraHasAreForTheNextStart) {
    OpenOther(Options("/dev/video0"));
    options_.controls = {{std::to_string(V4L2_CID_BRIGHTNESS), "7"}};
    V4l2Camera& camera = Await();
    kernel_.there = true;
    kernel_.controls = {{V4L2_CID_BRIGHTNESS, 0}};
    EXPECT_EQ(camera.Reopen().error(), Error::kUnsupported);
    EXPECT_TRUE(V4l2Camera::Open(options_, kernel_).ok());
}

TEST_F(V4l2AbsenceTest, NeitherItsAbsenceNorItsComingTakesMemory) {
    if (!tests::kHeapCallsAreCounted) GTEST_SKIP() << "a sanitizer owns malloc";
    const Bytes jpeg = tests::JpegPicture(64, 48, TJSAMP_422, 1);
    other_kernel_.fourcc = V4L2_PIX_FMT_MJPEG;
    OpenOther(Options("/dev/video0"));
    options_.orientation.rotation_deg = 180;
    kernel_.fourcc = V4L2_PIX_FMT_MJPEG;
    kernel_.controls = {{V4L2_CID_HFLIP, 0}, {V4L2_CID_VFLIP, 0}};
    // The kernel's stand-in takes memory of its own, and keeps it.
    kernel_.there = true;
    EXPECT_TRUE(V4l2Camera::Open(options_, kernel_).ok());
    kernel_.there = false;
    V4l2Camera& camera = Await();
    Script(jpeg);

    const std::uint64_t before = tests::HeapCallsOfThisThread();
    const Error absent = camera.WaitFrame(milliseconds(10)).error();
    const Error refused = camera.Reopen().error();
    kernel_.there = true;
    const bool there = camera.Reopen().ok();
    const auto frame = camera.WaitFrame(milliseconds(100));
    EXPECT_EQ(tests::HeapCallsOfThisThread(), before);
    EXPECT_EQ(absent, Error::kDisconnected);
    EXPECT_EQ(refused, Error::kNotFound);
    EXPECT_TRUE(there);
    EXPECT_TRUE(frame.ok());
}

}  // namespace
}  // namespace hitchview::drivers
