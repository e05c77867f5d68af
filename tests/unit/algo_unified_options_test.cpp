#include <gtest/gtest.h>

#include <vector>

#include "algo/seam_path.hpp"
#include "algo/unified_options.hpp"

namespace hitchview::algo {
namespace {

constexpr int kRows = 12;
constexpr int kCols = 20;
constexpr double kSpacing_px = 8;

/// Expensive but for two straight ways, columns 6 and 14.
std::vector<float> TwoWays(float left, float right) {
    std::vector<float> cost(kRows * kCols, 60);
    for (std::size_t row = 0; row < kRows; ++row) {
        cost[row * kCols + 6] = left;
        cost[row * kCols + 14] = right;
    }
    return cost;
}

/// Column of a seam, frame by frame, after the way it follows became dearer than the other one by
/// `gain` grey levels per row.
std::vector<double> SeamAfter(const Projection& canvas, float gain, int frames) {
    SeamPath path(kRows, kCols, kSpacing_px, SeamOptionsOf(canvas).path);
    path.FollowCheapest({2, 17}, TwoWays(10, 20));
    std::vector<double> x_px;
    for (int i = 0; i < frames; ++i) {
        path.FollowCheapest({2, 17}, TwoWays(10 + gain, 10));
        x_px.push_back(path.x_px(5));
    }
    return x_px;
}

const Projection kRing = Projection::Cylinder(2048, 360, 0.5);
const Projection kPlane = Projection::Plane(1280, 360);

TEST(SeamOptionsTest, ARingsSeamLeavesItsPlaceForASmallerGainThanAPlanes) {
    EXPECT_EQ(SeamAfter(kPlane, 2, 40).back(), 6 * kSpacing_px - 0.5);
    EXPECT_EQ(SeamAfter(kRing, 2, 40).back(), 14 * kSpacing_px - 0.5);
    EXPECT_EQ(SeamAfter(kRing, 0, 40).back(), 6 * kSpacing_px - 0.5) << "not for nothing";
}

TEST(SeamOptionsTest, ARingsSeamIsSoonerOutOfTheWayThanAPlanes) {
    const auto frames_on_the_way = [](const Projection& canvas) {
        int frames = 0;
        for (const double x_px : SeamAfter(canvas, 40, 60)) {
            if (x_px < 14 * kSpacing_px - 0.5) ++frames;
        }
        return frames;
    };
    EXPECT_LT(frames_on_the_way(kRing), 6);
    EXPECT_GT(frames_on_the_way(kPlane), 12);
    EXPECT_LT(frames_on_the_way(kPlane), 30);
}

}  // namespace
}  // namespace hitchview::algo
