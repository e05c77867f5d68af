#include <gtest/gtest.h>

#include <opencv2/core.hpp>
#include <opencv2/imgproc.hpp>

#include "algo/parallax_search.hpp"

namespace hitchview::algo {
namespace {

using Eigen::Vector2f;

cv::Mat1b Noise(int width, int height, std::uint64_t seed) {
    cv::Mat1b picture(height, width);
    cv::RNG(seed).fill(picture, cv::RNG::UNIFORM, 40, 220);
    cv::GaussianBlur(picture, picture, {}, 1.2);
    return picture;
}

cv::Mat1b Shifted(const cv::Mat1b& picture, int shift_px) {
    const cv::Matx23d by(1, 0, shift_px, 0, 1, 0);
    cv::Mat1b moved;
    cv::warpAffine(picture, moved, by, picture.size(), cv::INTER_NEAREST, cv::BORDER_REFLECT);
    return moved;
}

TEST(ParallaxSearchTest, AShiftFarBeyondThePatchIsFoundOnEitherSide) {
    const cv::Mat1b from = Noise(200, 60, 1);
    for (const int shift : {-38, -11, 0, 4, 31}) {
        const Vector2f at{100, 30};
        const auto found = SearchAlongRow(from, Shifted(from, shift), at, at, at, {-40, 40});
        ASSERT_TRUE(found) << shift;
        EXPECT_EQ(found->x(), at.x() + static_cast<float>(shift));
        EXPECT_EQ(found->y(), at.y());
    }
}

TEST(ParallaxSearchTest, BrightnessAndContrastMayDiffer) {
    const cv::Mat1b from = Noise(200, 60, 2);
    cv::Mat1b to;
    Shifted(from, 17).convertTo(to, CV_8U, 0.6, 30);
    const auto found = SearchAlongRow(from, to, {90, 30}, {90, 30}, {90, 30}, {0, 40});
    ASSERT_TRUE(found);
    EXPECT_EQ(found->x(), 107);
}

TEST(ParallaxSearchTest, RepetitionIsNoAnswerUnlessOnePlaceWasExpected) {
    cv::Mat1b fence(60, 220);
    for (int y = 0; y < fence.rows; ++y) {
        for (int x = 0; x < fence.cols; ++x)
            fence(y, x) = static_cast<std::uint8_t>(((x / 6) % 2 != 0 ? 180 : 60) + (y % 5) * 6);
    }
    const Vector2f at{100, 30};
    EXPECT_FALSE(SearchAlongRow(fence, fence, at, at, {500, 30}, {-30, 30}));
    const auto found = SearchAlongRow(fence, fence, at, at, {112.4F, 30}, {-30, 30});
    ASSERT_TRUE(found);
    EXPECT_EQ(found->x(), 112);
}

TEST(ParallaxSearchTest, NothingIsFoundWithoutTextureOrLikenessOrRoom) {
    const cv::Mat1b flat(60, 200, std::uint8_t{90});
    const cv::Mat1b from = Noise(200, 60, 3);
    const Vector2f at{100, 30};
    EXPECT_FALSE(SearchAlongRow(flat, flat, at, at, at, {-20, 20}));
    EXPECT_FALSE(SearchAlongRow(from, Noise(200, 60, 4), at, at, at, {-20, 20}));
    EXPECT_FALSE(SearchAlongRow(from, from, {2, 30}, {2, 30}, {2, 30}, {-20, 20}));
    EXPECT_FALSE(SearchAlongRow(from, from, at, {100, 2}, {100, 2}, {-20, 20}));
}

}  // namespace
}  // namespace hitchview::algo
