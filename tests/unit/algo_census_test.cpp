#include <gtest/gtest.h>

#include <bit>
#include <opencv2/core.hpp>

#include "algo/census.hpp"

namespace hitchview::algo {
namespace {

constexpr int kWidth = 61;  // no multiple of any vector
constexpr int kHeight = 24;

cv::Mat1b Noise(int seed) {
    cv::Mat1b picture(kHeight, kWidth);
    cv::RNG(static_cast<std::uint64_t>(seed)).fill(picture, cv::RNG::UNIFORM, 0, 256);
    return picture;
}

/// How many neighbours are darker than the centre at one place and not at the other.
int Difference(const cv::Mat1b& picture, const cv::Point& a, const cv::Point& b) {
    int different = 0;
    for (int dy = -Census::kHalf; dy <= Census::kHalf; ++dy) {
        for (int dx = -Census::kHalf; dx <= Census::kHalf; ++dx) {
            const cv::Point away(dx, dy);
            different += (picture(a + away) < picture(a)) != (picture(b + away) < picture(b));
        }
    }
    return different;
}

TEST(CensusTest, SignaturesDifferInAsManyBitsAsNeighboursCompareOtherwise) {
    const cv::Mat1b picture = Noise(5);
    Census census(kWidth, kHeight);
    census.Build(picture, cv::Mat1b(kHeight, kWidth, std::uint8_t{1}), 0, kWidth - 1, 1);
    for (int x = Census::kHalf; x < kWidth - Census::kHalf; ++x) {
        const cv::Point a(x, Census::kHalf + x % 17);
        const cv::Point b(kWidth - 1 - x, 12);
        EXPECT_EQ(std::popcount(census.At(a.x, a.y) ^ census.At(b.x, b.y)),
                  Difference(picture, a, b));
    }
}

TEST(CensusTest, ThereIsNoSignatureAtTheBorderOrUnderTheMask) {
    cv::Mat1b mask(kHeight, kWidth, std::uint8_t{255});
    mask(8, 20) = 0;
    Census census(kWidth, kHeight);
    census.Build(Noise(6), mask, 0, kWidth - 1, 2);
    EXPECT_EQ(census.At(20, 8), Census::kNone);
    EXPECT_EQ(census.At(21, 8) & Census::kNone, 0U);
    for (int x = 0; x < kWidth; ++x) {
        EXPECT_EQ(census.At(x, 2), Census::kNone);
        EXPECT_EQ(census.At(x, kHeight - 2), Census::kNone);
    }
    for (int y = 0; y < kHeight; y += 2) {
        EXPECT_EQ(census.At(2, y), Census::kNone);
        EXPECT_EQ(census.At(kWidth - 3, y), Census::kNone);
    }
}

}  // namespace
}  // namespace hitchview::algo
