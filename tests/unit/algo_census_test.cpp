#include <gtest/gtest.h>

#include <bit>
#include <opencv2/core.hpp>

#include "algo/census.hpp"

namespace hitchview::algo {
namespace {

cv::Mat1b RandomPicture(std::uint64_t seed) {
    cv::Mat1b picture(24, 40);
    cv::RNG random(seed);
    for (std::uint8_t& grey : picture) grey = static_cast<std::uint8_t>(random.uniform(0, 100));
    return picture;
}

Census Of(const cv::Mat1b& picture) {
    Census census(picture.cols, picture.rows);
    census.Build(picture, cv::Mat1b(picture.size(), std::uint8_t{1}), 0, picture.cols - 1, 1);
    return census;
}

template <typename Visitor>
void ForEachInside(const Visitor& visit) {
    for (int y = Census::kHalf; y < 24 - Census::kHalf; ++y) {
        for (int x = Census::kHalf; x < 40 - Census::kHalf; ++x) visit(x, y);
    }
}

TEST(CensusTest, AsManyBitsAreSetAsPixelsRoundItAreDarker) {
    const cv::Mat1b picture = RandomPicture(1);
    const Census census = Of(picture);
    ForEachInside([&](int x, int y) {
        const cv::Mat1b square =
            picture({y - Census::kHalf, y + Census::kHalf + 1}, {x - Census::kHalf, x + 4});
        EXPECT_EQ(std::popcount(census.At(x, y)), cv::countNonZero(square < picture(y, x)));
    });
}

TEST(CensusTest, EachPixelRoundItHasABitOfItsOwn) {
    std::uint64_t seen = 0;
    for (int dy = -Census::kHalf; dy <= Census::kHalf; ++dy) {
        for (int dx = -Census::kHalf; dx <= Census::kHalf; ++dx) {
            if (dx == 0 && dy == 0) continue;
            cv::Mat1b picture(24, 40, std::uint8_t{100});
            picture(12 + dy, 20 + dx) = 50;
            const std::uint64_t signature = Of(picture).At(20, 12);
            EXPECT_EQ(std::popcount(signature), 1) << dx << " " << dy;
            EXPECT_EQ(seen & signature, 0U) << dx << " " << dy;
            seen |= signature;
        }
    }
    EXPECT_EQ(std::popcount(seen), Census::kBits);
}

TEST(CensusTest, GainAndOffsetOfTheExposureChangeNothing) {
    const cv::Mat1b picture = RandomPicture(2);
    const Census census = Of(picture);
    const Census brighter = Of(cv::Mat1b(2 * picture + 30));
    ForEachInside([&](int x, int y) { EXPECT_EQ(brighter.At(x, y), census.At(x, y)); });
}

TEST(CensusTest, ASignatureGoesWithWhatThePictureShows) {
    const cv::Mat1b picture = RandomPicture(3);
    cv::Mat1b moved(picture.size(), std::uint8_t{0});
    picture({0, 22}, {0, 35}).copyTo(moved({2, 24}, {5, 40}));
    const Census census = Of(picture);
    const Census shifted = Of(moved);
    for (int x = 8; x < 28; ++x) EXPECT_EQ(shifted.At(x + 5, 12), census.At(x, 10)) << x;
}

TEST(CensusTest, BuildsAgainTheColumnsAskedForAndLeavesTheOthers) {
    const cv::Mat1b first = RandomPicture(4);
    const cv::Mat1b second = RandomPicture(5);
    const Census before = Of(first);
    const Census after = Of(second);
    Census census = before;
    census.Build(second, cv::Mat1b(second.size(), std::uint8_t{1}), 10, 20, 1);
    ForEachInside([&](int x, int y) {
        const Census& expected = x >= 10 && x <= 20 ? after : before;
        EXPECT_EQ(census.At(x, y), expected.At(x, y)) << x << " " << y;
    });
}

TEST(CensusTest, ThereIsNoSignatureAtTheBorderOrUnderTheMask) {
    cv::Mat1b mask(24, 40, std::uint8_t{255});
    mask(8, 20) = 0;
    Census census(40, 24);
    census.Build(RandomPicture(6), mask, 0, 40 - 1, 2);
    EXPECT_EQ(census.At(20, 8), Census::kNone);
    EXPECT_EQ(census.At(21, 8) & Census::kNone, 0U);
    for (int x = 0; x < 40; ++x) {
        EXPECT_EQ(census.At(x, 2), Census::kNone);
        EXPECT_EQ(census.At(x, 24 - 2), Census::kNone);
    }
    for (int y = 0; y < 24; y += 2) {
        EXPECT_EQ(census.At(2, y), Census::kNone);
        EXPECT_EQ(census.At(40 - 3, y), Census::kNone);
    }
}

}  // namespace
}  // namespace hitchview::algo
