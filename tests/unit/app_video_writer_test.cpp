#include <gtest/gtest.h>

#include <filesystem>
#include <opencv2/core.hpp>
#include <opencv2/imgproc.hpp>
#include <opencv2/videoio.hpp>

#include "app/video_writer.hpp"
#include "tests/support/temporary_folder.hpp"
#include "tests/support/test_pictures.hpp"

namespace hitchview::app {
namespace {

using tests::ColourWaves;
using tests::TemporaryFolder;

// A full-range I420 picture.
struct I420 {
    cv::Mat planes;

    explicit I420(const cv::Mat& bgr) {
        cv::Mat y_cr_cb;
        cv::Mat split[3];
        cv::cvtColor(bgr, y_cr_cb, cv::COLOR_BGR2YCrCb);
        cv::split(y_cr_cb, split);
        planes = split[0].reshape(1, 1);
        for (const int plane : {2, 1}) {
            cv::Mat half;
            cv::resize(split[plane], half, bgr.size() / 2, 0, 0, cv::INTER_AREA);
            cv::hconcat(planes, half.reshape(1, 1), planes);
        }
    }
    [[nodiscard]] hal::FrameView View(const hal::FrameFormat& format) const {
        return {format, {}, hal::PackedPlanes(format, planes.data)};
    }
};

hal::FrameFormat FormatOf(cv::Size size) {
    return {
        .width_px = size.width, .height_px = size.height, .pixel_format = hal::PixelFormat::kI420};
}

void Write(const std::string& path, const std::vector<cv::Mat>& pictures, double rate_hz) {
    const hal::FrameFormat format = FormatOf(pictures.front().size());
    auto writer = VideoWriter::Open(path, format, {.name = "test", .rate_hz = rate_hz});
    ASSERT_TRUE(writer) << writer.error();
    for (const cv::Mat& picture : pictures) {
        ASSERT_TRUE(writer.value()->Append(I420(picture).View(format)));
    }
    const auto finished = writer.value()->Finish();
    ASSERT_TRUE(finished) << finished.error();
}

std::vector<cv::Mat> ReadAll(const std::string& path) {
    std::vector<cv::Mat> pictures;
    cv::VideoCapture capture(path);
    for (cv::Mat picture; capture.read(picture);) pictures.push_back(picture.clone());
    return pictures;
}

TEST(VideoWriterTest, EveryFrameComesBackOnceInItsColours) {
    const TemporaryFolder folder;
    std::vector<cv::Mat> pictures;
    for (int i = 0; i < 40; ++i) pictures.push_back(ColourWaves({160, 96}, i));
    Write(folder / "a.avi", pictures, 29.5);
    const std::vector<cv::Mat> read = ReadAll(folder / "a.avi");
    ASSERT_EQ(read.size(), pictures.size());
    for (std::size_t i = 0; i < read.size(); ++i) {
        EXPECT_LT(cv::norm(read[i], pictures[i], cv::NORM_L1) / (3.0 * 160 * 96), 2.0) << i;
        EXPECT_LT(cv::norm(read[i], pictures[i], cv::NORM_INF), 14) << i;
    }
    EXPECT_NEAR(cv::VideoCapture(folder / "a.avi").get(cv::CAP_PROP_FPS), 29.5, 1e-6);
}

TEST(VideoWriterTest, BlackAwayFromThePictureStaysBlack) {
    const TemporaryFolder folder;
    cv::Mat picture(128, 256, CV_8UC3, cv::Scalar::all(0));
    const cv::Rect shown(64, 32, 96, 64);
    ColourWaves(shown.size(), 3).copyTo(picture(shown));
    Write(folder / "a.avi", {picture}, 30);
    cv::Mat read = ReadAll(folder / "a.avi").at(0);
    // Chroma blocks of 4:2:0 are 16 px wide: further away nothing of the picture can be seen.
    cv::rectangle(read, shown.tl() - cv::Point(16, 16), shown.br() + cv::Point(15, 15), {},
                  cv::FILLED);
    EXPECT_LT(cv::norm(read, cv::NORM_INF), 8);
}

TEST(VideoWriterTest, AFileThatCannotBeCreatedIsNamed) {
    const auto writer = VideoWriter::Open("/nowhere/a.avi", FormatOf({16, 16}), {.name = "test"});
    ASSERT_FALSE(writer);
    EXPECT_EQ(writer.error(), "/nowhere/a.avi: No such file or directory");
}

TEST(VideoWriterTest, AFullDiskIsReportedAndNobodyWaitsForEver) {
    if (!std::filesystem::exists("/dev/full")) GTEST_SKIP() << "no /dev/full";
    const cv::Mat picture = ColourWaves({320, 240}, 0);
    const hal::FrameFormat format = FormatOf(picture.size());
    auto writer = VideoWriter::Open("/dev/full", format, {.name = "test"});
    if (!writer) return;  // refused at once is as good
    const I420 planes(picture);
    for (int i = 0; i < 50; ++i) (void)writer.value()->Append(planes.View(format));
    EXPECT_FALSE(writer.value()->Finish());
}

TEST(AviFileTest, ARecordingOfSeveralSegmentsIsReadToItsEnd) {
    const TemporaryFolder folder;
    const std::vector<std::uint8_t> jpeg = [] {
        const TemporaryFolder single;
        Write(single / "a.avi", {ColourWaves({160, 96}, 0)}, 30);
        std::vector<std::uint8_t> bytes(std::filesystem::file_size(single / "a.avi"));
        std::FILE* const file = std::fopen((single / "a.avi").c_str(), "rb");
        EXPECT_EQ(std::fread(bytes.data(), 1, bytes.size(), file), bytes.size());
        std::fclose(file);
        const std::vector<std::uint8_t> begin{0xFF, 0xD8, 0xFF};
        const std::vector<std::uint8_t> end{0xFF, 0xD9};
        const auto first = std::search(bytes.begin(), bytes.end(), begin.begin(), begin.end());
        const auto last = std::search(first, bytes.end(), end.begin(), end.end());
        return std::vector<std::uint8_t>(first, last + 2);
    }();
    auto file = AviFile::Create(
        folder / "b.avi", {.width_px = 160,
                           .height_px = 96,
                           .segment_bytes = static_cast<std::uint32_t>(10 * (jpeg.size() + 16))});
    ASSERT_TRUE(file) << file.error();
    for (int i = 0; i < 37; ++i) ASSERT_TRUE(file.value()->Append(jpeg));
    ASSERT_TRUE(file.value()->Finish());
    EXPECT_EQ(ReadAll(folder / "b.avi").size(), 37U);
    EXPECT_EQ(cv::VideoCapture(folder / "b.avi").get(cv::CAP_PROP_FRAME_COUNT), 37);
}

}  // namespace
}  // namespace hitchview::app
