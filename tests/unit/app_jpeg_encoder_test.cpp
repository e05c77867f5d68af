#include <gtest/gtest.h>

#include <algorithm>
#include <opencv2/imgproc.hpp>

#include "app/jpeg_encoder.hpp"
#include "app/jpeg_picture.hpp"
#include "app/worker_pool.hpp"
#include "tests/support/i420_picture.hpp"

namespace hitchview::app {
namespace {

using tests::I420Picture;

cv::Mat Luma(const I420Picture& picture) {
    const hal::FrameView view = picture.view();
    const cv::Mat packed(view.format.height_px, view.format.width_px, CV_8UC1,
                         const_cast<std::uint8_t*>(view.planes[0].data));
    return packed.clone();
}

struct Picture {
    const char* name;
    int width_px;
    int height_px;
};

class JpegEncoderSizeTest : public testing::TestWithParam<Picture> {};

/// OpenCV's own BT.601 full-range conversion is the oracle of the colours.
cv::Mat ExpectedBgr(const I420Picture& picture) {
    const hal::FrameView view = picture.view();
    const cv::Size half(view.format.width_px / 2, view.format.height_px / 2);
    std::array<cv::Mat, 3> planes{Luma(picture)};
    for (int i : {1, 2}) {
        const cv::Mat chroma(half, CV_8UC1, const_cast<std::uint8_t*>(view.planes.at(i).data));
        cv::resize(chroma, planes.at(3 - i), planes[0].size(), 0, 0, cv::INTER_LINEAR);
    }
    cv::Mat ycrcb;
    cv::Mat bgr;
    cv::merge(planes, ycrcb);
    cv::cvtColor(ycrcb, bgr, cv::COLOR_YCrCb2BGR);
    return bgr;
}

TEST_P(JpegEncoderSizeTest, DecodingGivesThePictureBack) {
    const auto picture = I420Picture::Waves(GetParam().width_px, GetParam().height_px, 0);
    JpegEncoder encoder(picture.format(), {.budget_bytes = 500'000, .highest_quality = 95});

    const auto jpeg = encoder.Encode(picture.view());

    ASSERT_TRUE(jpeg);
    cv::Mat decoded;
    ASSERT_TRUE(DecodeJpeg(jpeg.value(), {GetParam().width_px, GetParam().height_px}, decoded));
    EXPECT_GT(cv::PSNR(decoded, ExpectedBgr(picture)), 36);
}

INSTANTIATE_TEST_SUITE_P(Sizes, JpegEncoderSizeTest,
                         testing::Values(Picture{"panorama", 2048, 360},
                                         Picture{"not_whole_blocks", 1100, 522},
                                         Picture{"last_slice_of_two_rows", 64, 50},
                                         Picture{"smallest", 2, 2}, Picture{"one_block", 16, 16}),
                         [](const auto& test) { return test.param.name; });

TEST(JpegEncoderTest, RowsWithGapsBetweenThemAreReadByTheirStride) {
    const auto packed = I420Picture::Waves(64, 32, 3);
    hal::FrameView view = packed.view();
    const hal::FrameView source = packed.view();
    std::array<std::vector<std::uint8_t>, 3> planes;
    for (std::size_t i = 0; i < 3; ++i) {
        const int width = i == 0 ? 64 : 32;
        const int rows = i == 0 ? 32 : 16;
        planes.at(i).assign(static_cast<std::size_t>(rows) * 100, 0xEE);
        for (int row = 0; row < rows; ++row) {
            std::copy_n(source.planes.at(i).data + row * width, width,
                        planes.at(i).data() + row * 100);
        }
        view.planes.at(i) = {planes.at(i).data(), 100};
    }

    JpegEncoder encoder(packed.format(), {});
    const auto first = encoder.Encode(source).value();
    const std::vector<std::uint8_t> expected(first.begin(), first.end());
    const auto second = encoder.Encode(view).value();
    EXPECT_EQ(std::vector<std::uint8_t>(second.begin(), second.end()), expected);
}

/// The same picture from a compressor that knows nothing of slices.
cv::Mat DecodedWithoutSlices(const I420Picture& picture, int quality) {
    const hal::FrameFormat format = picture.format();
    JpegSlice whole(format, 0, format.height_px, 0);
    std::vector<std::uint8_t> memory(whole.LargestBytes());
    cv::Mat decoded;
    EXPECT_TRUE(DecodeJpeg(whole.Compress(picture.view(), quality, memory),
                           {format.width_px, format.height_px}, decoded));
    return decoded;
}

TEST(JpegEncoderTest, SlicesCannotBeSeen) {
    for (const auto& [width, height] : {std::pair{640, 360}, {64, 50}, {4096, 720}, {33 * 2, 18}}) {
        const auto picture = I420Picture::Noise(width, height, 40, 7);
        JpegEncoder encoder(picture.format(), {.budget_bytes = 9'000'000, .highest_quality = 85});
        cv::Mat decoded;
        ASSERT_TRUE(DecodeJpeg(encoder.Encode(picture.view()).value(), {width, height}, decoded));
        EXPECT_EQ(cv::norm(decoded, DecodedWithoutSlices(picture, 85), cv::NORM_INF), 0) << width;
    }
}

TEST(JpegEncoderTest, TheBytesDoNotDependOnTheThreads) {
    const auto picture = I420Picture::Noise(640, 362, 60, 3);
    JpegEncoder alone(picture.format(), {});
    JpegEncoder shared(picture.format(), {});
    WorkerPool workers(3);
    for (int i = 0; i < 20; ++i) {
        const auto expected = alone.Encode(picture.view()).value();
        const auto jpeg = shared.Encode(picture.view(), workers).value();
        ASSERT_TRUE(std::ranges::equal(jpeg, expected));
    }
}

TEST(JpegEncoderTest, TheBudgetHoldsOnNoise) {
    for (const int amplitude : {16, 64, 128, 255}) {
        JpegEncoder encoder({2048, 360, hal::PixelFormat::kI420, hal::Range::kFull}, {});
        for (unsigned seed = 0; seed < 3; ++seed) {
            const auto jpeg = encoder.Encode(I420Picture::Noise(2048, 360, amplitude, seed).view());
            ASSERT_TRUE(jpeg) << amplitude;
            EXPECT_LE(jpeg.value().size(), 150'000U) << amplitude;
            EXPECT_GE(encoder.quality(), JpegQualityGovernor::kLowestQuality);
        }
        RecordProperty("quality_at_" + std::to_string(amplitude), encoder.quality());
    }
}

TEST(JpegEncoderTest, ABudgetThatNoQualityMeetsIsTooLarge) {
    const auto noise = I420Picture::Noise(2048, 360, 255, 1);
    JpegEncoder encoder(noise.format(), {.budget_bytes = 15'000});

    const auto jpeg = encoder.Encode(noise.view());
    ASSERT_FALSE(jpeg);
    EXPECT_EQ(jpeg.error(), hal::Error::kTooLarge);
    EXPECT_TRUE(encoder.Encode(I420Picture(2048, 360).view())) << "and the next one is fine";
}

TEST(JpegEncoderTest, TheQualityRecoversWhenTheNoiseIsGone) {
    const auto noise = I420Picture::Noise(512, 96, 64, 1);
    const auto calm = I420Picture::Waves(512, 96, 0);
    JpegEncoder encoder(noise.format(), {.budget_bytes = 12'000, .highest_quality = 85});
    ASSERT_TRUE(encoder.Encode(noise.view()));
    const int lowered = encoder.quality();
    ASSERT_LT(lowered, 60);

    for (int i = 0; i < 30 * (85 - lowered); ++i) ASSERT_TRUE(encoder.Encode(calm.view()));
    EXPECT_EQ(encoder.quality(), 85);
}

TEST(JpegPictureTest, DamageAndAnotherSizeAreRefused) {
    const auto picture = I420Picture::Waves(64, 32, 0);
    JpegEncoder encoder(picture.format(), {});
    const auto jpeg = encoder.Encode(picture.view()).value();
    cv::Mat bgr;
    EXPECT_FALSE(DecodeJpeg(jpeg, {64, 34}, bgr));
    EXPECT_FALSE(DecodeJpeg(jpeg.first(jpeg.size() / 2), {64, 32}, bgr));
    EXPECT_FALSE(DecodeJpeg({}, {64, 32}, bgr));
    EXPECT_TRUE(bgr.empty());
    EXPECT_TRUE(DecodeJpeg(jpeg, {64, 32}, bgr));
}

}  // namespace
}  // namespace hitchview::app
