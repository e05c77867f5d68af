#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <memory>
#include <vector>

#include "drivers/v4l2_camera.hpp"
#include "tests/support/fake_v4l2_kernel.hpp"
#include "tests/support/jpeg_picture.hpp"

namespace hitchview::drivers {
namespace {

using hal::Error;
using std::chrono::microseconds;
using std::chrono::milliseconds;
using testing::HasSubstr;

/// A driver that answers what a sound one does not.
class V4l2FailureTest : public testing::Test {
 protected:
    V4l2FailureTest() {
        options_.name = "fake";
        options_.path = "/dev/video7";
        options_.wish = {{64, 48}, 100, "best"};
        options_.buffers = kBuffers;
        options_.silence_periods = 2;
    }

    hal::Checked<std::unique_ptr<V4l2Camera>> Open() { return V4l2Camera::Open(options_, kernel_); }

    /// Opened, and past what came before the first call.
    std::unique_ptr<V4l2Camera> OpenSound() {
        auto camera = Open();
        EXPECT_TRUE(camera.ok()) << camera.error();
        EXPECT_EQ((*camera)->WaitFrame(milliseconds(1)).error(), Error::kTimeout);
        return std::move(*camera);
    }

    void Script(int frames) {
        for (int i = 0; i < frames; ++i, ++sequence_)
            kernel_.script.push_back(
                {sequence_, microseconds(10'000 * sequence_), tests::Bytes(64 * 48, 9)});
    }

    static constexpr int kBuffers = 20;
    tests::FakeV4l2Kernel kernel_;
    V4l2CameraOptions options_;
    std::uint32_t sequence_ = 1;  // the stamp of 0 would be none
};

TEST_F(V4l2FailureTest, ARequestThatFailsIsNamedAndNothingStaysMapped) {
    const std::pair<unsigned long, const char*> requests[] = {{VIDIOC_REQBUFS, "VIDIOC_REQBUFS"},
                                                              {VIDIOC_QUERYBUF, "VIDIOC_QUERYBUF"},
                                                              {VIDIOC_QBUF, "VIDIOC_QBUF"},
                                                              {VIDIOC_STREAMON, "VIDIOC_STREAMON"}};
    for (const auto& [request, name] : requests) {
        kernel_.failing = {{request, ENOMEM}};
        const auto camera = Open();
        ASSERT_FALSE(camera.ok()) << name;
        EXPECT_THAT(camera.error(), HasSubstr(name));
        EXPECT_THAT(camera.error(), HasSubstr("Cannot allocate memory"));
        EXPECT_EQ(kernel_.mapped, 0) << name;
    }
    kernel_.failing.clear();
    EXPECT_TRUE(Open().ok());
}

TEST_F(V4l2FailureTest, FewerBuffersThanAskedAreRefused) {
    kernel_.most_buffers = kBuffers - 1;
    EXPECT_THAT(Open().error(), HasSubstr("gives fewer buffers than asked"));
    kernel_.most_buffers = kBuffers;
    EXPECT_TRUE(Open().ok());
}

TEST_F(V4l2FailureTest, BuffersThatCannotBeMappedAreNamed) {
    kernel_.maps = false;
    for (const bool exports : {true, false}) {
        kernel_.exports = exports;
        EXPECT_THAT(Open().error(), HasSubstr("mmap"));
    }
}

TEST_F(V4l2FailureTest, AFilledBufferThatItWasNeverGivenEndsTheStream) {
    const auto camera = OpenSound();
    for (const std::uint32_t index : {std::uint32_t{kBuffers}, ~std::uint32_t{0}}) {
        kernel_.filled_index = index;
        Script(1);
        EXPECT_EQ(camera->WaitFrame(std::chrono::seconds(10)).error(), Error::kDisconnected);
        kernel_.filled_index.reset();
        EXPECT_TRUE(camera->Reopen().ok());
    }
    Script(1);
    EXPECT_TRUE(camera->WaitFrame(std::chrono::seconds(10)).ok());
}

TEST_F(V4l2FailureTest, ADriverThatLetsGoIsAskedToWhenTheStreamEnds) {
    for (const bool lets_go : {false, true}) {
        kernel_.lets_go = lets_go;
        OpenSound();
        EXPECT_EQ(kernel_.let_go, lets_go ? 1 : 0);
    }
}

TEST_F(V4l2FailureTest, FramesThatAreNeverGivenBackKeepItFromComingBackUntilTheyAre) {
    const auto camera = OpenSound();
    std::vector<hal::FrameLease> held;
    int streams = 0;
    do {
        Script(kBuffers);
        for (int i = 0; i < kBuffers; ++i) {
            auto frame = camera->WaitFrame(milliseconds(100));
            ASSERT_TRUE(frame.ok());
            held.push_back(std::move(frame.value()));
        }
        kernel_.failure = ENODEV;
        EXPECT_EQ(camera->WaitFrame(std::chrono::seconds(10)).error(), Error::kDisconnected);
        kernel_.failure = 0;
        ASSERT_LT(++streams, 10);
    } while (camera->Reopen().ok());
    EXPECT_EQ(kernel_.mapped, static_cast<int>(held.size()));
    EXPECT_EQ(held.front().view().planes[0].data[0], 9) << "what is lent stays readable";
    held.clear();
    EXPECT_TRUE(camera->Reopen().ok());
    EXPECT_EQ(kernel_.mapped, kBuffers);
}

}  // namespace
}  // namespace hitchview::drivers
