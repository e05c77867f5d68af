#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <chrono>
#include <numeric>
#include <opencv2/imgproc.hpp>
#include <random>
#include <string>
#include <thread>
#include <vector>

#include "drivers/libcamera_camera.hpp"
#include "drivers/libcamera_format.hpp"
#include "drivers/libcamera_mailbox.hpp"
#include "drivers/libcamera_stamps.hpp"

namespace hitchview::drivers {
namespace {

using std::chrono::milliseconds;
using std::chrono::seconds;

const LibcameraPixelFormat& Format(const std::string& name) {
    for (const LibcameraPixelFormat& format : LibcameraPixelFormats()) {
        if (name == format.name) return format;
    }
    ADD_FAILURE() << name;
    return LibcameraPixelFormats().front();
}

std::vector<std::uint8_t> Noise(std::size_t bytes) {
    std::mt19937 generator(7);
    std::vector<std::uint8_t> noise(bytes);
    for (std::uint8_t& value : noise) value = static_cast<std::uint8_t>(generator());
    return noise;
}

TEST(LibcameraFormatTest, PlanesOfNv12FollowEachOtherInOneMemoryOrLieInTwo) {
    const LibcameraLayout layout{&Format("nv12"), 6, 4, 8};
    const std::vector<std::uint8_t> memory(8 * 6);
    const auto one = PlanesOf(layout, {memory});
    ASSERT_TRUE(one);
    EXPECT_EQ((*one)[1].data, memory.data() + 32);
    EXPECT_EQ((*one)[1].stride_bytes, 8);
    const std::vector<std::uint8_t> chroma(8 * 2);
    const auto two = PlanesOf(layout, {std::span(memory).first(32), chroma});
    ASSERT_TRUE(two);
    EXPECT_EQ((*two)[1].data, chroma.data());
}

TEST(LibcameraFormatTest, AMemoryThatEndsBeforeItsPictureIsNoFrame) {
    const LibcameraLayout layout{&Format("yuyv"), 6, 4, 16};
    const std::vector<std::uint8_t> memory(16 * 3 + 12);
    EXPECT_EQ(LeastBytes(layout), memory.size());
    EXPECT_TRUE(PlanesOf(layout, {memory}));
    EXPECT_FALSE(PlanesOf(layout, {std::span(memory).first(memory.size() - 1)}));
    EXPECT_FALSE(PlanesOf({&Format("nv12"), 6, 4, 8}, {std::span(memory).first(32)}));
}

TEST(LibcameraFormatTest, LinesMustNotRunIntoEachOther) {
    EXPECT_TRUE(HoldsLines({&Format("yuyv"), 6, 4, 12}));
    EXPECT_FALSE(HoldsLines({&Format("yuyv"), 6, 4, 11}));
    EXPECT_FALSE(HoldsLines({&Format("rgb888"), 6, 4, -1}));
}

TEST(LibcameraFormatTest, CopyingLeavesOutThePaddingOfLines) {
    const LibcameraLayout layout{&Format("nv12"), 4, 2, 6};
    std::vector<std::uint8_t> memory(18);
    std::iota(memory.begin(), memory.end(), std::uint8_t{0});
    std::vector<std::uint8_t> frame(12);
    FillPacked(layout, *PlanesOf(layout, {memory}), frame);
    EXPECT_THAT(frame, testing::ElementsAre(0, 1, 2, 3, 6, 7, 8, 9, 12, 13, 14, 15));
}

struct Order {
    const char* format;
    int to_ycrcb;  ///< of OpenCV
};

class LibcameraColourTest : public testing::TestWithParam<Order> {};

TEST_P(LibcameraColourTest, ThreeBytesAPixelBecomeTheNv12OfOpenCv) {
    constexpr int kWidth = 64;
    constexpr int kHeight = 32;
    constexpr int kStride = kWidth * 3 + 20;
    const LibcameraLayout layout{&Format(GetParam().format), kWidth, kHeight, kStride};
    std::vector<std::uint8_t> memory = Noise(kStride * kHeight);
    std::vector<std::uint8_t> frame(kWidth * kHeight * 3 / 2);
    FillPacked(layout, *PlanesOf(layout, {memory}), frame);

    const cv::Mat packed(kHeight, kWidth, CV_8UC3, memory.data(), kStride);
    cv::Mat ycrcb;
    cv::cvtColor(packed, ycrcb, GetParam().to_ycrcb);
    // Chroma of OpenCV is per pixel, and clipped there: the mean of four is within one and a bit.
    for (int y = 0; y < kHeight; ++y) {
        for (int x = 0; x < kWidth; ++x) {
            const int luma = frame[static_cast<std::size_t>(y * kWidth + x)];
            ASSERT_NEAR(luma, ycrcb.at<cv::Vec3b>(y, x)[0], 1) << x << " " << y;
        }
    }
    for (int y = 0; y < kHeight; y += 2) {
        for (int x = 0; x < kWidth; x += 2) {
            const cv::Scalar mean = cv::mean(ycrcb(cv::Rect(x, y, 2, 2)));
            const std::size_t at = static_cast<std::size_t>((kHeight + y / 2) * kWidth + x);
            ASSERT_NEAR(frame[at], mean[2], 1.6) << x << " " << y;
            ASSERT_NEAR(frame[at + 1], mean[1], 1.6) << x << " " << y;
        }
    }
}

// DRM names them from the most significant bit down, OpenCV as they lie in memory.
INSTANTIATE_TEST_SUITE_P(Orders, LibcameraColourTest,
                         testing::Values(Order{"rgb888", cv::COLOR_BGR2YCrCb},
                                         Order{"bgr888", cv::COLOR_RGB2YCrCb}));

TEST(LibcameraStampTest, StampsAreTheSameWhileTheMachineHasNotSlept) {
    LibcameraStampClock clock;
    EXPECT_EQ(clock.ToMonotonic(seconds(9), {seconds(10), seconds(10)}), seconds(9));
}

TEST(LibcameraStampTest, AStampOfTheClockThatSleepsNotIsBroughtBack) {
    LibcameraStampClock clock;
    const BootClocks now{seconds(10), seconds(110)};
    EXPECT_EQ(clock.ToMonotonic(seconds(109), now), seconds(9));
}

TEST(LibcameraStampTest, AMonotonicStampStaysThoughTheMachineHasSlept) {
    LibcameraStampClock clock;
    EXPECT_EQ(clock.ToMonotonic(seconds(9), {seconds(10), seconds(110)}), seconds(9));
}

TEST(LibcameraStampTest, AStampAheadOfBothClocksIsOfNeither) {
    LibcameraStampClock clock;
    const BootClocks now{seconds(10), seconds(110)};
    EXPECT_EQ(clock.ToMonotonic(seconds(111), now), seconds(10));
    EXPECT_EQ(clock.ToMonotonic(seconds(9), now), seconds(9)) << "nor does it tell of the next one";
}

TEST(LibcameraStampTest, WhatWasOnceSeenToBeBoottimeStaysIt) {
    LibcameraStampClock clock;
    EXPECT_EQ(clock.ToMonotonic(milliseconds(10010), {seconds(10), milliseconds(10040)}),
              milliseconds(9970));
    // Late: by itself it could be of either clock.
    EXPECT_EQ(clock.ToMonotonic(milliseconds(10090), {milliseconds(10100), milliseconds(10140)}),
              milliseconds(10050));
}

TEST(LibcameraMailboxTest, FilledSlotsComeInOrderAndOneByOne) {
    LibcameraMailbox mailbox;
    for (const int slot : {3, 1, 2}) mailbox.NoteFilled(slot);
    for (const int slot : {3, 1, 2}) EXPECT_EQ(mailbox.Take({}).filled, slot);
    EXPECT_FALSE(mailbox.Take({}).filled);
}

TEST(LibcameraMailboxTest, ASlotThatIsReturnedTwiceIsNoticed) {
    LibcameraMailbox mailbox;
    EXPECT_TRUE(mailbox.NoteReturned(5));
    EXPECT_FALSE(mailbox.NoteReturned(5));
    EXPECT_EQ(mailbox.Take({}).returned, 1ULL << 5);
    EXPECT_TRUE(mailbox.NoteReturned(5));
}

TEST(LibcameraMailboxTest, TheEndOfAStreamForgetsFramesButNotWhatIsReturned) {
    LibcameraMailbox mailbox;
    mailbox.NoteFilled(1);
    mailbox.NoteReturned(2);
    mailbox.NoteGone();
    mailbox.ForgetStream();
    const LibcameraMailbox::News news = mailbox.Take({});
    EXPECT_FALSE(news.filled);
    EXPECT_FALSE(news.gone);
    EXPECT_EQ(news.returned, 1ULL << 2);
}

TEST(LibcameraMailboxTest, WhatComesFromAnotherThreadWakesTheOneThatWaits) {
    LibcameraMailbox mailbox;
    std::thread other([&] { mailbox.NoteFilled(4); });
    EXPECT_EQ(mailbox.Take(seconds(60)).filled, 4);
    other.join();
}

TEST(LibcameraTest, AnIdThatIsNotThereIsAnErrorThatNamesIt) {
    LibcameraOptions options;
    options.id = "nowhere";
    const auto camera = OpenLibcamera(options);
    ASSERT_FALSE(camera.ok());
    EXPECT_THAT(camera.error(), testing::HasSubstr("nowhere: "));
}

}  // namespace
}  // namespace hitchview::drivers
