#include <gtest/gtest.h>

#include "algo/corner_grid.hpp"

namespace hitchview::algo {
namespace {

using Eigen::Vector2d;

TEST(CornerGridTest, ItsCornersReachOverAllPixelsOfTheCanvas) {
    for (const int length_px : {8, 9, 100, 104, 2048}) {
        const CornerScalars grid(Projection::Plane(length_px, 8), 0);
        EXPECT_GE(grid.Pixel(0, grid.cols() - 1).x(), length_px - 0.5) << length_px;
        EXPECT_LT(grid.Pixel(0, grid.cols() - 2).x(), length_px - 0.5) << length_px;
    }
    const CornerField field(Projection::Plane(100, 40), {1, 2});
    EXPECT_EQ(field.rows(), 6);
    EXPECT_EQ(field.cols(), 14);
    EXPECT_EQ(field.at(5, 13), Eigen::Vector2f(1, 2));
}

TEST(CornerGridTest, AFieldThatIsLinearIsReadExactlyEverywhere) {
    CornerScalars grid(Projection::Plane(96, 48), 0);
    const auto value = [](const Vector2d& p) { return 3 + 0.5 * p.x() - 0.25 * p.y(); };
    for (int row = 0; row < grid.rows(); ++row) {
        for (int col = 0; col < grid.cols(); ++col)
            grid.at(row, col) = static_cast<float>(value(grid.Pixel(row, col)));
    }
    for (double y = -0.5; y <= 47.5; y += 1.7) {
        for (double x = -0.5; x <= 95.5; x += 2.3)
            EXPECT_NEAR(grid.Sample({x, y}), value({x, y}), 1e-4) << x << " " << y;
    }
    EXPECT_NEAR(grid.Sample({-30, 20}), value({-0.5, 20}), 1e-4) << "beyond: the edge's value";
    EXPECT_NEAR(grid.Sample({500, 99}), value({95.5, 47.5}), 1e-4);
}

TEST(CornerGridTest, WithoutCornersItIsEmpty) {
    EXPECT_TRUE(CornerField().empty());
    EXPECT_EQ(CornerField().rows(), 0);
    EXPECT_FALSE(CornerField(Projection::Plane(8, 8), {0, 0}).empty());
}

}  // namespace
}  // namespace hitchview::algo
