#include <gtest/gtest.h>

#include <Eigen/LU>
#include <opencv2/core.hpp>

#include "algo/fold_guard.hpp"

namespace hitchview::algo {
namespace {

using Eigen::Vector2d;

class FoldGuardTest : public testing::TestWithParam<Projection> {
 protected:
    /// Noise of `size_px` at every vertex.
    [[nodiscard]] VertexField Noise(double size_px) const {
        cv::RNG random(9);
        VertexField field;
        for (int i = 0; i < Mesh::kVertices; ++i) {
            for (int axis = 0; axis < 2; ++axis)
                field(axis, i) = static_cast<float>(random.gaussian(size_px));
        }
        CloseRing(mesh_, field);
        return field;
    }

    /// Smallest ratio of the area of a triangle of the mesh to its area at rest.
    [[nodiscard]] double LeastArea(const VertexField& field) const {
        double least = 1e9;
        for (int row = 0; row < Mesh::kRows; ++row) {
            for (int col = 0; col < Mesh::kCols; ++col) {
                const Vector2d a = At(field, row, col);
                const Vector2d b = At(field, row + 1, col + 1);
                for (const Vector2d& c : {At(field, row, col + 1), At(field, row + 1, col)}) {
                    Eigen::Matrix2d sides;
                    sides << b - a, c - a;
                    least = std::min(least, std::abs(sides.determinant()));
                    const double turn = c == At(field, row, col + 1) ? -1 : 1;
                    least = std::min(least, turn * sides.determinant());
                }
            }
        }
        return least / (mesh_.cell_px.x() * mesh_.cell_px.y());
    }

    Mesh mesh_{GetParam()};

 private:
    [[nodiscard]] Vector2d At(const VertexField& field, int row, int col) const {
        return mesh_.Vertex(row, col) + field.col(Mesh::Index(row, col)).cast<double>();
    }
};

INSTANTIATE_TEST_SUITE_P(PlaneAndRing, FoldGuardTest,
                         testing::Values(Projection::Plane(640, 360),
                                         Projection::Cylinder(1024, 180, 0.5)));

TEST_P(FoldGuardTest, AFieldWithinTheLimitStaysBitForBit) {
    const VertexField calm = Noise(0.3);
    VertexField field = calm;
    GuardFolds(mesh_, kMaxStretch, field);
    EXPECT_EQ(field, calm);
}

TEST_P(FoldGuardTest, WhateverTheFieldNothingFolds) {
    for (const double size_px : {5.0, 30.0, 3000.0}) {
        VertexField field = Noise(size_px);
        EXPECT_LT(LeastArea(field), 0.2) << "it would be no test";
        GuardFolds(mesh_, kMaxStretch, field);
        EXPECT_GT(LeastArea(field), 0.19) << size_px;
        for (int row = 0; mesh_.ring && row < Mesh::kVertexRows; ++row) {
            EXPECT_EQ(field.col(Mesh::Index(row, 0)), field.col(Mesh::Index(row, Mesh::kCols)));
        }
    }
}

TEST_P(FoldGuardTest, FarFromASteepPlaceNothingChanges) {
    VertexField field = VertexField::Constant(3);
    field(0, Mesh::Index(5, 10)) = 40;
    GuardFolds(mesh_, kMaxStretch, field);
    EXPECT_LT(field(0, Mesh::Index(5, 10)), 39);
    EXPECT_NEAR(field(0, Mesh::Index(5, 28)), 3, 0.1);
    EXPECT_LT((field.row(1).array() - 3).abs().maxCoeff(), 0.1);
}

}  // namespace
}  // namespace hitchview::algo
