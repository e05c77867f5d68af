#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <filesystem>
#include <opencv2/core.hpp>
#include <opencv2/imgcodecs.hpp>
#include <opencv2/imgproc.hpp>
#include <opencv2/videoio.hpp>

#include "drivers/replay_camera.hpp"
#include "tests/support/temporary_folder.hpp"
#include "tests/support/test_pictures.hpp"

namespace hitchview::drivers {
namespace {

using std::chrono::milliseconds;
using tests::ColourWaves;
using tests::TemporaryFolder;

constexpr milliseconds kLong{10'000};

std::unique_ptr<ReplayCamera> Open(const std::string& path, double rate_hz = 0) {
    auto camera = ReplayCamera::Open(path, {.name = "test", .rate_hz = rate_hz, .slots = 4});
    EXPECT_TRUE(camera) << camera.error();
    return std::move(*camera);
}

std::string WhyNot(const std::string& path) {
    const auto camera = ReplayCamera::Open(path, {.name = "test"});
    return camera ? "it opened" : camera.error();
}

int CountFrames(ReplayCamera& camera) {
    int frames = 0;
    while (camera.WaitFrame(kLong)) ++frames;
    return frames;
}

// Largest error of luma, and of chroma averaged over 2 x 2 pixels, against OpenCV's conversion.
struct ColourError {
    double luma;
    double chroma;
};

ColourError Compare(const hal::FrameView& view, const cv::Mat& bgr) {
    const cv::Size size(view.format.width_px, view.format.height_px);
    cv::Mat planes[3];
    cv::Mat y_cr_cb;
    cv::cvtColor(bgr({{}, size}), y_cr_cb, cv::COLOR_BGR2YCrCb);
    cv::split(y_cr_cb, planes);
    const auto wrap = [&](int plane, cv::Size plane_size, int type) {
        const hal::Plane& p = view.planes[static_cast<std::size_t>(plane)];
        return cv::Mat(plane_size, type, const_cast<std::uint8_t*>(p.data),
                       static_cast<std::size_t>(p.stride_bytes));
    };
    cv::Mat chroma[2];
    cv::split(wrap(1, size / 2, CV_8UC2), chroma);
    for (cv::Mat* plane : {&planes[1], &planes[2]}) {
        cv::resize(*plane, *plane, size / 2, 0, 0, cv::INTER_AREA);
    }
    return {cv::norm(wrap(0, size, CV_8U), planes[0], cv::NORM_INF),
            std::max(cv::norm(chroma[0], planes[2], cv::NORM_INF),
                     cv::norm(chroma[1], planes[1], cv::NORM_INF))};
}

void WriteSequence(const TemporaryFolder& folder, const char* pattern, int first, int count,
                   cv::Size size, const std::vector<int>& parameters = {}) {
    for (int i = 0; i < count; ++i) {
        const std::string name = cv::format(pattern, first + i);
        ASSERT_TRUE(cv::imwrite(folder / name, ColourWaves(size, i), parameters));
    }
}

void WriteVideo(const std::string& path, int frames, cv::Size size, double rate_hz) {
    cv::VideoWriter writer(path, cv::CAP_OPENCV_MJPEG, cv::VideoWriter::fourcc('M', 'J', 'P', 'G'),
                           rate_hz, size);
    ASSERT_TRUE(writer.isOpened());
    writer.set(cv::VIDEOWRITER_PROP_QUALITY, 98);
    for (int i = 0; i < frames; ++i) writer.write(ColourWaves(size, i));
}

TEST(ReplayCameraTest, APngSequenceKeepsColoursOrderAndTimes) {
    const TemporaryFolder folder;
    WriteSequence(folder, "%05d.png", 1, 20, {64, 48});
    const auto camera = Open(folder / "%05d.png", 25);
    EXPECT_EQ(camera->format(), (hal::FrameFormat{.width_px = 64, .height_px = 48}));
    for (int i = 0; i < 20; ++i) {
        const auto frame = camera->WaitFrame(kLong);
        ASSERT_TRUE(frame) << ToString(frame.error());
        const hal::FrameView& view = frame.value().view();
        EXPECT_EQ(view.header.sequence, static_cast<unsigned>(i));
        EXPECT_EQ(view.header.captured_at, milliseconds(40) * i);
        const ColourError error = Compare(view, ColourWaves({64, 48}, i));
        EXPECT_LE(error.luma, 1) << i;
        EXPECT_LE(error.chroma, 1) << i;
    }
    EXPECT_EQ(camera->WaitFrame(kLong).error(), hal::Error::kEndOfStream);
    EXPECT_EQ(camera->WaitFrame(kLong).error(), hal::Error::kEndOfStream);
}

TEST(ReplayCameraTest, AJpegSequenceKeepsColours) {
    const TemporaryFolder folder;
    WriteSequence(folder, "%02d.jpg", 0, 3, {64, 48}, {cv::IMWRITE_JPEG_QUALITY, 98});
    const auto camera = Open(folder / "%02d.jpg");
    EXPECT_EQ(camera->rate_hz(), 30);
    for (int i = 0; i < 3; ++i) {
        const auto frame = camera->WaitFrame(kLong);
        ASSERT_TRUE(frame);
        const ColourError error = Compare(frame.value().view(), ColourWaves({64, 48}, i));
        EXPECT_LE(error.luma, 6) << i;
        EXPECT_LE(error.chroma, 6) << i;
    }
}

TEST(ReplayCameraTest, AGreyJpegHasNoColour) {
    const TemporaryFolder folder;
    ASSERT_TRUE(cv::imwrite(folder / "0.jpg", cv::Mat(32, 48, CV_8U, cv::Scalar(200))));
    const auto camera = Open(folder / "%d.jpg");
    const auto frame = camera->WaitFrame(kLong);
    ASSERT_TRUE(frame);
    EXPECT_NEAR(frame.value().view().planes[0].data[100], 200, 1);
    EXPECT_EQ(frame.value().view().planes[1].data[100], 128);
}

TEST(ReplayCameraTest, AMotionJpegVideoGivesEveryFrameOnceWithItsColours) {
    const TemporaryFolder folder;
    WriteVideo(folder / "a.avi", 23, {96, 64}, 10);
    const auto camera = Open(folder / "a.avi");
    EXPECT_DOUBLE_EQ(camera->rate_hz(), 10);
    for (int i = 0; i < 23; ++i) {
        const auto frame = camera->WaitFrame(kLong);
        ASSERT_TRUE(frame) << i;
        const ColourError error = Compare(frame.value().view(), ColourWaves({96, 64}, i));
        EXPECT_LE(error.luma, 8) << i;
        EXPECT_LE(error.chroma, 10) << i;
    }
    EXPECT_EQ(camera->WaitFrame(kLong).error(), hal::Error::kEndOfStream);
}

TEST(ReplayCameraTest, AnOddSizeLosesItsLastRowAndColumn) {
    const TemporaryFolder folder;
    WriteSequence(folder, "%d.png", 0, 1, {65, 49});
    WriteSequence(folder, "%d.jpg", 0, 1, {65, 49}, {cv::IMWRITE_JPEG_QUALITY, 98});
    for (const char* name : {"%d.png", "%d.jpg"}) {
        const auto camera = Open(folder / name);
        const auto frame = camera->WaitFrame(kLong);
        ASSERT_TRUE(frame);
        EXPECT_EQ(frame.value().view().format.width_px, 64);
        EXPECT_EQ(frame.value().view().format.height_px, 48);
        EXPECT_LE(Compare(frame.value().view(), ColourWaves({65, 49}, 0)).luma, 6) << name;
    }
}

TEST(ReplayCameraTest, AFolderIsReadInNaturalOrder) {
    const TemporaryFolder folder;
    for (const int i : {1, 2, 10, 9}) {
        const cv::Mat grey(16, 16, CV_8UC3, cv::Scalar::all(10 * i));
        ASSERT_TRUE(cv::imwrite(folder / cv::format("frame%d.png", i), grey));
    }
    folder.Write("notes.txt", "no picture");
    const auto camera = Open(folder.path());
    for (const int i : {1, 2, 9, 10}) {
        const auto frame = camera->WaitFrame(kLong);
        ASSERT_TRUE(frame);
        EXPECT_EQ(frame.value().view().planes[0].data[0], 10 * i);
    }
}

TEST(ReplayCameraTest, AReaderThatKeepsItsFramesMakesTheDecoderWait) {
    const TemporaryFolder folder;
    WriteSequence(folder, "%03d.png", 0, 12, {32, 32});
    const auto camera = Open(folder / "%03d.png");
    std::vector<hal::FrameLease> kept;
    for (int i = 0; i < 4; ++i) kept.push_back(std::move(*camera->WaitFrame(kLong)));
    EXPECT_EQ(camera->WaitFrame(milliseconds(1)).error(), hal::Error::kTimeout);
    EXPECT_LE(Compare(kept[0].view(), ColourWaves({32, 32}, 0)).luma, 1);
    kept.clear();
    EXPECT_EQ(CountFrames(*camera), 8);
}

TEST(ReplayCameraTest, ADamagedOrDifferentPictureIsReportedInItsPlace) {
    const TemporaryFolder folder;
    WriteSequence(folder, "%d.jpg", 0, 5, {64, 48});
    ASSERT_TRUE(cv::imwrite(folder / "1.jpg", ColourWaves({32, 48}, 1)));
    std::filesystem::resize_file(folder / "2.jpg",
                                 std::filesystem::file_size(folder / "2.jpg") / 2);
    folder.Write("3.jpg", "not a picture");
    const auto camera = Open(folder / "%d.jpg");
    EXPECT_TRUE(camera->WaitFrame(kLong));
    for (int i = 1; i < 4; ++i) {
        const auto frame = camera->WaitFrame(kLong);
        ASSERT_FALSE(frame) << i;
        EXPECT_EQ(frame.error(), hal::Error::kCorrupted) << i;
    }
    const auto last = camera->WaitFrame(kLong);
    ASSERT_TRUE(last);
    EXPECT_EQ(last.value().view().header.sequence, 4U);
}

TEST(ReplayCameraTest, APictureCutOffInItsHeaderLeavesTheNextAsItIs) {
    const TemporaryFolder folder;
    WriteSequence(folder, "%d.jpg", 0, 2, {64, 48});
    std::filesystem::resize_file(folder / "1.jpg", 300);
    std::filesystem::copy_file(folder / "0.jpg", folder / "2.jpg");
    const auto camera = Open(folder / "%d.jpg");
    const auto first = camera->WaitFrame(kLong);
    EXPECT_FALSE(camera->WaitFrame(kLong));
    const auto next = camera->WaitFrame(kLong);
    ASSERT_TRUE(first && next);
    const auto pixels = [](const hal::FrameView& view) {
        return std::vector(view.planes[0].data, view.planes[0].data + hal::FrameBytes(view.format));
    };
    EXPECT_EQ(pixels(next.value().view()), pixels(first.value().view()));
}

TEST(ReplayCameraTest, AFolderNamedLikeAPictureIsReportedInItsPlace) {
    const TemporaryFolder folder;
    WriteSequence(folder, "%d.jpg", 0, 1, {64, 48});
    std::filesystem::create_directory(folder / "1.jpg");
    const auto camera = Open(folder.path());
    EXPECT_TRUE(camera->WaitFrame(kLong));
    EXPECT_EQ(camera->WaitFrame(kLong).error(), hal::Error::kCorrupted);
}

TEST(ReplayCameraTest, WhatCannotBeOpenedSaysWhy) {
    const TemporaryFolder folder;
    folder.Write("text.avi", "this is no video");
    WriteSequence(folder, "gap%d.png", 0, 4, {16, 16});
    std::filesystem::remove(folder / "gap2.png");
    WriteSequence(folder, "late%d.png", 7, 2, {16, 16});
    using testing::HasSubstr;
    EXPECT_THAT(WhyNot(folder / "none.avi"), HasSubstr("none.avi: no such file"));
    EXPECT_THAT(WhyNot(folder / "text.avi"), HasSubstr("text.avi: not a video"));
    EXPECT_THAT(WhyNot(folder / "gap%d.png"), HasSubstr("number 2 is missing"));
    EXPECT_THAT(WhyNot(folder / "late%d.png"), HasSubstr("first number is 7"));
    for (const char* name : {"x%s.png", "%0d.png", "%00d.png", "%5d.png", "%012d.png", "%d%d.png",
                             "%d%%.png", "%.png", "%", "%0", "%05"}) {
        EXPECT_THAT(WhyNot(folder / name), HasSubstr("must have one number")) << name;
    }
    EXPECT_THAT(WhyNot(folder / "x%d.png"), HasSubstr("no such files"));
}

TEST(ReplayCameraTest, DyingEarlyLosesNoThread) {
    const TemporaryFolder folder;
    WriteSequence(folder, "%d.png", 0, 9, {16, 16});
    for (int i = 0; i < 20; ++i) {
        const auto camera = Open(folder / "%d.png");
        EXPECT_TRUE(i % 2 == 0 || camera->WaitFrame(kLong));
    }
}

}  // namespace
}  // namespace hitchview::drivers
