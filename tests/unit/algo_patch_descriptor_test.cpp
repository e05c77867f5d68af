#include <gtest/gtest.h>

#include "algo/patch_descriptor.hpp"
#include "tests/support/test_pictures.hpp"

namespace hitchview::algo {
namespace {

GreyPyramid PyramidOf(const cv::Mat1b& picture) {
    GreyPyramid pyramid(picture.cols, picture.rows);
    picture.copyTo(pyramid.base());
    pyramid.Build();
    return pyramid;
}

const GreyPyramid& Textured() {
    static const GreyPyramid pyramid = [] {
        cv::Mat1b picture = tests::Texture({400, 300}, 21);
        cv::GaussianBlur(picture, picture, {}, 2.5);
        cv::normalize(picture, picture, 20, 235, cv::NORM_MINMAX);
        return PyramidOf(picture);
    }();
    return pyramid;
}

std::vector<Eigen::Vector2f> Points() {
    std::vector<Eigen::Vector2f> points;
    for (float y = 40; y < 260; y += 44) {
        for (float x = 40; x < 360; x += 44) points.emplace_back(x, y);
    }
    return points;
}

TEST(PatchDescriptorTest, ABrighterAndFlatterPictureLeavesTheDescriptorNearlyAsItIs) {
    cv::Mat1b changed;
    Textured().level(0).convertTo(changed, CV_8U, 0.7, 40);
    const GreyPyramid other = PyramidOf(changed);
    for (const Eigen::Vector2f& point : Points()) {
        const auto a = DescribePatch(Textured(), 0, point);
        const auto b = DescribePatch(other, 0, point);
        ASSERT_TRUE(a && b);
        // Only comparisons within the rounding to whole grey levels may turn.
        EXPECT_LT(a->Distance(*b), 12);
    }
}

TEST(PatchDescriptorTest, AMonotoneChangeOfTheComparedPixelsChangesNoBit) {
    GreyPyramid curved = PyramidOf(Textured().level(0));
    cv::Mat1b compared = curved.level(1);  // shares its pixels with the pyramid
    for (std::uint8_t& grey : compared) {
        grey = static_cast<std::uint8_t>(80 + grey / 3 * 2);
    }
    cv::Mat1b steps = Textured().level(1).clone();
    for (std::uint8_t& grey : steps) grey = static_cast<std::uint8_t>(grey / 3);
    GreyPyramid coarse = PyramidOf(Textured().level(0));
    steps.copyTo(cv::Mat1b(coarse.level(1)));
    for (const Eigen::Vector2f& point : Points()) {
        EXPECT_EQ(DescribePatch(curved, 0, point)->Distance(*DescribePatch(coarse, 0, point)), 0);
    }
}

TEST(PatchDescriptorTest, UnrelatedPatchesAreAboutHalfOfTheBitsApart) {
    const std::vector<Eigen::Vector2f> points = Points();
    double sum = 0;
    int pairs = 0;
    int closest = 256;
    for (std::size_t i = 0; i < points.size(); ++i) {
        for (std::size_t k = 0; k < i; ++k, ++pairs) {
            const int distance = DescribePatch(Textured(), 0, points[i])
                                     ->Distance(*DescribePatch(Textured(), 0, points[k]));
            sum += distance;
            closest = std::min(closest, distance);
        }
    }
    EXPECT_NEAR(sum / pairs, 128, 10);
    EXPECT_GT(closest, 40);
}

TEST(PatchDescriptorTest, DistanceCountsTheBitsThatDiffer) {
    const PatchDescriptor none;
    const PatchDescriptor some{{1, 0, 0xFF, std::uint64_t{1} << 63}};
    EXPECT_EQ(none.Distance(none), 0);
    EXPECT_EQ(none.Distance(some), 10);
    EXPECT_EQ(some.Distance(none), 10);
}

TEST(PatchDescriptorTest, IsEmptyNearTheEdgeAndOnTheLastLevel) {
    EXPECT_TRUE(DescribePatch(Textured(), 0, {18, 18}));
    EXPECT_FALSE(DescribePatch(Textured(), 0, {16, 100}));
    EXPECT_FALSE(DescribePatch(Textured(), 0, {100, 16}));
    EXPECT_FALSE(DescribePatch(Textured(), 0, {383, 100}));
    EXPECT_FALSE(DescribePatch(Textured(), 0, {100, 283}));
    EXPECT_FALSE(DescribePatch(Textured(), Textured().levels() - 1, {10, 10}));
}

}  // namespace
}  // namespace hitchview::algo
