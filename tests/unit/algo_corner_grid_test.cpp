#include <gtest/gtest.h>

#include <random>

#include "algo/corner_grid.hpp"
#include "algo/corner_mesh.hpp"

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

TEST(CornerMeshTest, AtTheCornersItSaysWhatTheMeshSays) {
    for (const Projection& canvas :
         {Projection::Cylinder(4096, 720, 0.5), Projection::Cylinder(1000, 170, 0.4),
          Projection::Plane(331, 203)}) {
        const Mesh mesh(canvas);
        std::mt19937 random(4);
        std::uniform_real_distribution<float> value(-30, 30);
        VertexField field;
        for (float& number : field.reshaped()) number = value(random);
        CloseRing(mesh, field);
        const CornerMesh corner_mesh(canvas);
        CornerField at_corners(canvas, Eigen::Vector2f(99, 99));
        for (int row = 0; row < at_corners.rows(); ++row) {
            corner_mesh.SampleRow(field, row, at_corners);
            for (int col = 0; col < at_corners.cols(); ++col) {
                const Eigen::Vector2d expected = Sample(mesh, field, at_corners.Pixel(row, col));
                EXPECT_LT((at_corners.at(row, col).cast<double>() - expected).norm(), 1e-4)
                    << row << " " << col;
            }
        }
    }
}

}  // namespace
}  // namespace hitchview::algo
