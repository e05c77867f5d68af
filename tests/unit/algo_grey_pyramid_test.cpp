#include <gtest/gtest.h>

#include <opencv2/imgproc.hpp>

#include "algo/grey_pyramid.hpp"

namespace hitchview::algo {
namespace {

cv::Mat1b Noise(cv::Size size) {
    cv::Mat1b picture(size);
    cv::RNG random(static_cast<std::uint64_t>(size.width * 1000 + size.height));
    random.fill(picture, cv::RNG::UNIFORM, 0, 256);
    return picture;
}

class GreyPyramidTest : public testing::TestWithParam<cv::Size> {};

TEST_P(GreyPyramidTest, EveryLevelIsPyrDownOfTheOneBelow) {
    const cv::Size size = GetParam();
    GreyPyramid pyramid(size.width, size.height);
    Noise(size).copyTo(pyramid.base());
    pyramid.Build();
    for (int l = 1; l < pyramid.levels(); ++l) {
        cv::Mat1b expected;
        cv::pyrDown(pyramid.level(l - 1), expected);
        ASSERT_EQ(pyramid.level(l).size(), expected.size()) << "level " << l;
        EXPECT_EQ(cv::norm(pyramid.level(l), expected, cv::NORM_INF), 0) << "level " << l;
    }
}

TEST_P(GreyPyramidTest, KeepsTheShorterSideAtTwentyFourPixelsOrMoreAndNoLevelLess) {
    const cv::Size size = GetParam();
    const GreyPyramid pyramid(size.width, size.height);
    const cv::Size last = pyramid.level(pyramid.levels() - 1).size();
    EXPECT_TRUE(pyramid.levels() == 1 || std::min(last.width, last.height) >= 24) << last;
    if (pyramid.levels() < GreyPyramid::kMaxLevels) {
        EXPECT_LT((std::min(last.width, last.height) + 1) / 2, 24);
    }
}

INSTANTIATE_TEST_SUITE_P(Sizes, GreyPyramidTest,
                         testing::Values(cv::Size(1, 1), cv::Size(7, 5), cv::Size(47, 47),
                                         cv::Size(48, 49), cv::Size(49, 48), cv::Size(333, 111),
                                         cv::Size(640, 480), cv::Size(1023, 479)),
                         [](const auto& test) {
                             return std::to_string(test.param.width) + "x" +
                                    std::to_string(test.param.height);
                         });

TEST(GreyPyramidSwapTest, SwappedPyramidsKeepTheirPicturesAndCanBeBuiltAgain) {
    GreyPyramid dark(64, 64);
    GreyPyramid noise(101, 97);
    dark.base().setTo(10);
    Noise({101, 97}).copyTo(noise.base());
    dark.Build();
    noise.Build();
    swap(dark, noise);
    EXPECT_EQ(noise.level(1)(3, 3), 10);
    dark.Build();
    cv::Mat1b expected;
    cv::pyrDown(dark.level(0), expected);
    EXPECT_EQ(cv::norm(dark.level(1), expected, cv::NORM_INF), 0);
}

}  // namespace
}  // namespace hitchview::algo
