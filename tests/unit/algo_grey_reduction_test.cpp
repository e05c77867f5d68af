#include <gtest/gtest.h>

#include <opencv2/core.hpp>
#include <vector>

#include "algo/grey_reduction.hpp"

namespace hitchview::algo {
namespace {

/// Samples at random, `step` bytes apart, in rows without a byte to spare.
struct RandomPlane {
    RandomPlane(int cols, int rows, int step)
        : bytes(static_cast<std::size_t>(cols * rows * step)),
          plane{bytes.data() + step - 1, cols * step, step, cols, rows} {
        cv::RNG random(7);
        for (std::uint8_t& byte : bytes) byte = static_cast<std::uint8_t>(random.uniform(0, 256));
    }
    [[nodiscard]] int MeanOf(int x, int y, int side) const {
        int sum = side * side / 2;
        for (int v = 0; v < side; ++v) {
            for (int u = 0; u < side; ++u)
                sum += plane.row(y * side + v)[(x * side + u) * plane.step_bytes];
        }
        return sum / (side * side);
    }

    std::vector<std::uint8_t> bytes;
    SamplePlane plane;
};

class GreyReductionTest : public testing::TestWithParam<int> {};

TEST_P(GreyReductionTest, TakesTheMeanOfEachSquareOfThePartThatIsUsedAndOfNoOther) {
    const int side = GetParam();
    constexpr int kWidth = 22;
    constexpr int kHeight = 5;
    for (const int step : {1, 2}) {
        const RandomPlane random(kWidth * side, kHeight * side, step);
        for (const cv::Rect used : {cv::Rect(0, 0, kWidth, kHeight), cv::Rect(3, 1, 18, 3)}) {
            cv::Mat1b reduced(kHeight, kWidth, std::uint8_t{0});
            GreyReduction(side, kWidth).Reduce(random.plane, used, reduced);
            for (int y = 0; y < kHeight; ++y) {
                for (int x = 0; x < kWidth; ++x) {
                    const bool inside = used.contains(cv::Point(x, y));
                    EXPECT_EQ(reduced(y, x), inside ? random.MeanOf(x, y, side) : 0)
                        << x << " " << y << " step " << step;
                }
            }
        }
    }
}

INSTANTIATE_TEST_SUITE_P(Sides, GreyReductionTest, testing::Values(1, 2, 4, 8));

}  // namespace
}  // namespace hitchview::algo
