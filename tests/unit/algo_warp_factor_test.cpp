#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

#include "algo/warp_factor.hpp"

namespace hitchview::algo {
namespace {

using Eigen::Matrix3d;
using Eigen::Vector2d;

/// A smooth field whose largest steps are a tenth of a cell.
VertexField Waves(const Mesh& mesh, double amplitude_px) {
    VertexField field;
    for (int row = 0; row < Mesh::kVertexRows; ++row) {
        for (int col = 0; col < Mesh::kVertexCols; ++col) {
            const double turn = 2 * std::numbers::pi * col / Mesh::kCols;  // closes on a ring
            field.col(Mesh::Index(row, col)) =
                amplitude_px * Eigen::Vector2f(std::sin(turn + 0.4 * row), std::cos(turn));
        }
    }
    CloseRing(mesh, field);
    return field;
}

VertexField WarpOf(const Projection& view, const Matrix3d& pose, const VertexField& rest) {
    const Mesh mesh(view);
    VertexField warp;
    for (int row = 0; row < Mesh::kVertexRows; ++row) {
        for (int col = 0; col < Mesh::kVertexCols; ++col) {
            const int i = Mesh::Index(row, col);
            const Vector2d v = mesh.Vertex(row, col);
            const Vector2d moved = v + rest.col(i).cast<double>();
            warp.col(i) = view.Difference(view.Pixel(pose * view.Ray(moved)), v).cast<float>();
        }
    }
    return warp;
}

class WarpFactorTest : public testing::TestWithParam<Projection> {
 protected:
    const Projection view_ = GetParam();
    const Mesh mesh_{view_};
    const Matrix3d pose_ = ToPose(view_, {{25, 0.02, -0.015}});
};

TEST_P(WarpFactorTest, AWarpThatIsAPoseLeavesNoRest) {
    const FactoredWarp found = FactorWarp(view_, WarpOf(view_, pose_, VertexField::Zero()));
    EXPECT_LT((found.pose - pose_).cwiseAbs().maxCoeff(), 1e-3);
    EXPECT_LT(found.rest.cwiseAbs().maxCoeff(), 1e-3);
}

TEST_P(WarpFactorTest, ReadingBackwardsUndoesTheWarp) {
    const VertexField warp = WarpOf(view_, pose_, Waves(mesh_, 4));
    const FactoredWarp found = FactorWarp(view_, warp);
    for (int row = 1; row < Mesh::kRows; ++row) {
        for (int col = 1; col < Mesh::kCols; ++col) {
            const Vector2d v = mesh_.Vertex(row, col);
            const Vector2d shown = v + warp.col(Mesh::Index(row, col)).cast<double>();
            const Vector2d y = view_.Pixel(found.pose.inverse() * view_.Ray(shown));
            const Vector2d read = y - Sample(mesh_, found.rest, y);
            EXPECT_LT(view_.Difference(read, v).norm(), 0.12) << row << ' ' << col;
        }
    }
}

TEST_P(WarpFactorTest, TheRestIsSmallerThanTheWarp) {
    const VertexField warp = WarpOf(view_, pose_, Waves(mesh_, 4));
    EXPECT_LT(FactorWarp(view_, warp).rest.norm(), 0.4F * warp.norm());
}

INSTANTIATE_TEST_SUITE_P(Projections, WarpFactorTest,
                         testing::Values(Projection::Plane(640, 360),
                                         Projection::Cylinder(1024, 180, 0.5)));

}  // namespace
}  // namespace hitchview::algo
