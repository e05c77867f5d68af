#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <opencv2/core.hpp>
#include <random>
#include <vector>

#include "algo/seam_cost.hpp"
#include "algo/seam_path.hpp"

namespace hitchview::algo {
namespace {

constexpr int kRows = 12;
constexpr int kCols = 20;
constexpr double kSpacing = 8;
constexpr SeamPath::Range kRange{2, 17};

using Cost = std::vector<float>;

Cost Flat(float value) {
    return Cost(kRows * kCols, value);
}

float& At(Cost& cost, int row, int col) {
    return cost[static_cast<std::size_t>(row * kCols + col)];
}

/// A cheap valley along the columns `col(row)` in an expensive plain.
template <typename Column>
Cost Valley(Column&& col) {
    Cost cost = Flat(40);
    for (int row = 0; row < kRows; ++row) At(cost, row, col(row)) = 0;
    return cost;
}

double ColumnOf(const SeamPath& path, int row) {
    return (path.x_px(row) + 0.5) / kSpacing;
}

/// Cheapest price over all paths, by trying every one from a corner downwards.
double Cheapest(const Cost& cost, float step_cost, int rows, int row, int col) {
    if (col < kRange.first || col > kRange.last) return INFINITY;
    const double here = cost[static_cast<std::size_t>(row * kCols + col)];
    if (row + 1 == rows) return here;
    double below = INFINITY;
    for (const int side : {-1, 0, 1}) {
        below = std::min(below, Cheapest(cost, step_cost, rows, row + 1, col + side) +
                                    double{step_cost} * std::abs(side));
    }
    return here + below;
}

TEST(SeamPathTest, TheFirstPathFollowsAValleyThatWinds) {
    const auto valley = [](int row) { return 9 + std::abs(row - 6) / 2; };
    SeamPath path(kRows, kCols, kSpacing, {});
    EXPECT_FALSE(path.known());
    path.FollowCheapest(kRange, Valley(valley));
    EXPECT_TRUE(path.known());
    for (int row = 0; row < kRows; ++row) EXPECT_EQ(ColumnOf(path, row), valley(row)) << row;
}

TEST(SeamPathTest, NoOtherPathIsCheaper) {
    const SeamPathOptions options{.middle_cost = 0};
    for (std::uint64_t seed = 1; seed < 6; ++seed) {
        cv::RNG random(seed);
        Cost cost = Flat(0);
        for (float& value : cost) value = random.uniform(0.0F, 20.0F);
        SeamPath path(kRows, kCols, kSpacing, options);
        path.FollowCheapest(kRange, cost);
        double price = 0;
        for (int row = 0; row < kRows; ++row) {
            const auto col = static_cast<int>(std::lround(ColumnOf(path, row)));
            price += At(cost, row, col);
            if (row == 0) continue;
            const double step = std::abs(ColumnOf(path, row) - ColumnOf(path, row - 1));
            EXPECT_LE(step, 1) << "bounded slope";
            price += options.step_cost * step;
        }
        double least = INFINITY;
        for (int col = kRange.first; col <= kRange.last; ++col)
            least = std::min(least, Cheapest(cost, options.step_cost, kRows, 0, col));
        EXPECT_NEAR(price, least, 1e-3) << seed;
    }
}

TEST(SeamPathTest, WithoutAReasonItLiesInTheMiddleOfTheRange) {
    SeamPath path(kRows, kCols, kSpacing, {});
    path.FollowCheapest({4, 12}, Flat(3));
    for (int row = 0; row < kRows; ++row) EXPECT_EQ(ColumnOf(path, row), 8);
}

TEST(SeamPathTest, APathThatIsALittleCheaperDoesNotReplaceTheChosenOne) {
    SeamPath path(kRows, kCols, kSpacing, {});
    const auto cost = [](float left, float right) {
        Cost both = Flat(60);
        for (int row = 0; row < kRows; ++row) {
            At(both, row, 7) = left;
            At(both, row, 12) = right;
        }
        return both;
    };
    path.FollowCheapest(kRange, cost(10, 20));
    ASSERT_EQ(ColumnOf(path, 5), 7);
    for (int i = 0; i < 20; ++i) path.FollowCheapest(kRange, cost(11, 10));
    EXPECT_EQ(ColumnOf(path, 5), 7) << "hysteresis";
    for (int i = 0; i < 20; ++i) path.FollowCheapest(kRange, cost(40, 10));
    EXPECT_EQ(ColumnOf(path, 5), 12) << "a clear win";
}

TEST(SeamPathTest, WhatIsDrawnGlidesAtABoundedSpeedAndArrives) {
    const SeamPathOptions options{.glide_px = 3};
    SeamPath path(kRows, kCols, kSpacing, options);
    path.FollowCheapest(kRange, Valley([](int) { return 5; }));
    const Cost moved = Valley([](int row) { return 13 + row % 2; });
    for (int frame = 0; frame < 30; ++frame) {
        std::array<double, kRows> before;
        for (int row = 0; row < kRows; ++row)
            before[static_cast<std::size_t>(row)] = path.x_px(row);
        path.FollowCheapest(kRange, moved);
        for (int row = 0; row < kRows; ++row) {
            const double moved_px = path.x_px(row) - before[static_cast<std::size_t>(row)];
            ASSERT_LE(std::abs(moved_px), options.glide_px + 1e-9) << frame;
            ASSERT_GE(moved_px, 0);
        }
    }
    for (int row = 0; row < kRows; ++row) EXPECT_EQ(ColumnOf(path, row), 13 + row % 2);
    EXPECT_NEAR(path.mean_px(), 13.5 * kSpacing - 0.5, 1e-9);
}

/// A thing that the units show in different places, as wide as four columns, in a cheap plain.
Cost ThingAt(int col) {
    Cost cost = Flat(1);
    for (int row = 4; row < 10; ++row) {
        for (int c = col; c < col + 4; ++c) At(cost, row, c) = 400;
    }
    return cost;
}

/// Most rows that cut the thing at any time as it passes the path, a column per frame.
int MostRowsCut(SeamPath& path) {
    int most = 0;
    for (int first = kRange.first - 4; first <= kRange.last - 4; ++first) {
        Cost cost = ThingAt(std::max(0, first));
        path.FollowCheapest(kRange, cost);
        int cut = 0;
        for (int row = 0; row < kRows; ++row) {
            const auto col = static_cast<int>(std::lround(ColumnOf(path, row)));
            cut += At(cost, row, col) > 1 ? 1 : 0;
        }
        most = std::max(most, cut);
    }
    return most;
}

TEST(SeamPathTest, AThingThatMovesAlongWithTheGlidingPathIsSkippedAndNotCut) {
    SeamPathOptions options{.glide_px = static_cast<float>(kSpacing)};
    SeamPath gliding(kRows, kCols, kSpacing, options);
    EXPECT_GT(MostRowsCut(gliding), 0);
    options.dearest_way = 30;
    SeamPath skipping(kRows, kCols, kSpacing, options);
    EXPECT_EQ(MostRowsCut(skipping), 0);
}

TEST(SeamPathTest, WhereTheWayIsCheapThePathGlidesAlthoughItMaySkip) {
    const SeamPathOptions options{.glide_px = 3, .dearest_way = 30};
    SeamPath path(kRows, kCols, kSpacing, options);
    Cost cost = Flat(5);
    for (int row = 0; row < kRows; ++row) At(cost, row, 5) = 0;
    path.FollowCheapest(kRange, cost);
    ASSERT_EQ(ColumnOf(path, 0), 5);
    cost = Flat(5);
    for (int row = 0; row < kRows; ++row) At(cost, row, 13) = 0;
    path.FollowCheapest(kRange, cost);
    for (int row = 0; row < kRows; ++row)
        EXPECT_NEAR(path.x_px(row), 5 * kSpacing - 0.5 + options.glide_px, 1e-9);
}

TEST(SeamPathTest, ARangeThatMovesTakesTheChosenPathWithIt) {
    SeamPath path(kRows, kCols, kSpacing, {});
    path.FollowCheapest({2, 8}, Valley([](int) { return 6; }));
    for (int i = 0; i < 40; ++i) path.FollowCheapest({10, 16}, Flat(5));
    for (int row = 0; row < kRows; ++row) {
        EXPECT_GE(ColumnOf(path, row), 10);
        EXPECT_LE(ColumnOf(path, row), 16);
    }
}

TEST(SeamPathTest, AStraightColumnIsReachedAtOnceAndThenByItsGain) {
    SeamPath path(kRows, kCols, kSpacing, {});
    path.FollowColumn(50, 0.1);
    EXPECT_EQ(path.x_px(3), 50);
    path.FollowColumn(70, 0.1);
    EXPECT_NEAR(path.x_px(3), 52, 1e-9);
}

GreyPatch Patch(float grey) {
    GreyPatch patch;
    patch.cell.fill(grey);
    return patch;
}

TEST(SeamCostTest, DifferentPicturesCostMoreThanEqualOnesAndUnseenOnesMore) {
    SeamCost cost(3, {});
    cost.ObserveBoth(0, Patch(90), Patch(90), {});
    cost.ObserveBoth(1, Patch(90), Patch(98), {});
    cost.ObserveOne(2);
    EXPECT_EQ(cost.cost()[0], 0);
    EXPECT_NEAR(cost.cost()[1], 8, 1e-5);
    EXPECT_GT(cost.cost()[2], cost.cost()[1]);
}

TEST(SeamCostTest, AnEdgeThatLiesElsewhereCostsThoughTheMeanIsEqual) {
    GreyPatch left = Patch(50);
    GreyPatch right = Patch(50);
    left.cell[0] = right.cell[1] = 150;
    EXPECT_NEAR(left.Difference(right), 50, 1e-5);
}

TEST(SeamCostTest, WhatMovesCostsMoreThanWhatStandsStillAndStaysSoForAWhile) {
    SeamCost cost(2, {});
    for (int frame = 0; frame < 20; ++frame) {
        cost.ObserveBoth(0, Patch(100), Patch(110), {});
        cost.ObserveBoth(1, Patch(100), Patch(frame % 2 == 0 ? 105 : 115), {});
    }
    EXPECT_GT(cost.cost()[1], cost.cost()[0] + 10);
    for (int frame = 0; frame < 3; ++frame) cost.ObserveBoth(1, Patch(100), Patch(110), {});
    EXPECT_GT(cost.cost()[1], cost.cost()[0] + 5);
    for (int frame = 0; frame < 90; ++frame) cost.ObserveBoth(1, Patch(100), Patch(110), {});
    EXPECT_NEAR(cost.cost()[1], cost.cost()[0], 0.1);
}

TEST(SeamCostTest, AFieldThatBendsCosts) {
    SeamCost cost(2, {});
    cost.ObserveBoth(0, Patch(100), Patch(100), {});
    cost.ObserveBoth(1, Patch(100), Patch(100), {.bend = 0.3F});
    EXPECT_GT(cost.cost()[1], cost.cost()[0] + 5);
}

TEST(SeamCostTest, AFieldThatMayBeWrongCosts) {
    SeamCost cost(2, {});
    cost.ObserveBoth(0, Patch(100), Patch(100), {});
    cost.ObserveBoth(1, Patch(100), Patch(100), {.doubt_px = 2});
    EXPECT_GT(cost.cost()[1], cost.cost()[0] + 5);
}

TEST(SeamCostTest, APatchIsTheMeanGreyOfItsCellsWithTheGain) {
    std::array<std::uint8_t, 32 * 16> luma{};
    for (std::size_t i = 0; i < luma.size(); ++i) luma[i] = i % 32 < 16 ? 40 : 80;
    CameraFrame frame;
    frame.width_px = 32;
    frame.height_px = 16;
    frame.luma = luma.data();
    frame.luma_stride_bytes = 32;
    const GreyPatch patch = ReadGreyPatch(frame, 1.5F, 16, 8);
    EXPECT_NEAR(patch.cell[0], 60, 1e-4);
    EXPECT_NEAR(patch.cell[1], 120, 1e-4);
    EXPECT_NEAR(ReadGreyPatch(frame, 1, 31, 0).cell[0], 80, 1e-4) << "moved inwards at the edge";
}

TEST(SeamCostTest, APatchOfEveryLayoutIsTheMeanOfItsPixelsAlsoAtTheEdges) {
    constexpr int kWidth = 22;
    constexpr int kHeight = 18;
    std::mt19937 random(8);
    std::vector<std::uint8_t> bytes(2 * kWidth * kHeight);
    for (std::uint8_t& byte : bytes) byte = static_cast<std::uint8_t>(random());
    for (const PixelLayout layout :
         {PixelLayout::kGrey, PixelLayout::kNv12, PixelLayout::kUyvy, PixelLayout::kYuyv}) {
        CameraFrame frame;
        frame.width_px = kWidth;
        frame.height_px = kHeight;
        frame.layout = layout;
        frame.luma = bytes.data();
        frame.luma_stride_bytes = frame.is_packed() ? 2 * kWidth : kWidth;
        const SamplePlane luma = frame.LumaSamples();
        for (int y = 0; y < kHeight; ++y) {
            for (int x = 0; x < kWidth; ++x) {
                const int left = std::clamp(x - 4, 0, kWidth - 8);
                const int top = std::clamp(y - 4, 0, kHeight - 8);
                std::array<int, 4> sums{};
                for (int r = 0; r < 8; ++r) {
                    for (int c = 0; c < 8; ++c)
                        sums[static_cast<std::size_t>(r / 4 * 2 + c / 4)] +=
                            luma.row(top + r)[(left + c) * luma.step_bytes];
                }
                const GreyPatch patch = ReadGreyPatch(frame, 1, static_cast<float>(x) + 0.5F,
                                                      static_cast<float>(y) + 0.5F);
                for (std::size_t cell = 0; cell < sums.size(); ++cell)
                    EXPECT_EQ(patch.cell[cell], static_cast<float>(sums[cell]) / 16) << x << y;
            }
        }
    }
}

}  // namespace
}  // namespace hitchview::algo
