#include <gtest/gtest.h>

#include <opencv2/core.hpp>
#include <vector>

#include "algo/vertex_propagation.hpp"

namespace hitchview::algo {
namespace {

using Eigen::Vector2d;
using Eigen::Vector2f;

const Projection kPlane = Projection::Plane(640, 200);
const Projection kRing = Projection::Cylinder(640, 200, 0.5);

std::vector<PointMotion> Everywhere(const Vector2d& motion, double step_px = 12) {
    std::vector<PointMotion> points;
    for (double y = 0; y < 200; y += step_px) {
        for (double x = 0; x < 640; x += step_px) points.push_back({{x, y}, motion});
    }
    return points;
}

TEST(VertexPropagationTest, AUniformMotionMovesEveryVertexByNearlyThatMotion) {
    const Mesh mesh(kPlane);
    VertexField field;
    VertexScalars votes;
    PropagateToVertices(mesh, Everywhere({4, -2}), {}, field, &votes);
    // A corner of the picture hears a quarter of the points that the middle hears.
    EXPECT_GE(votes.minCoeff(), 20);
    for (int i = 0; i < Mesh::kVertices; ++i) {
        const float share = votes(i) / (votes(i) + 3);
        EXPECT_NEAR(field(0, i), 4, 4 * (1 - share) + 1e-4F) << i;
        EXPECT_GT(field(0, i), 3.4F) << i;
        EXPECT_NEAR(field(1, i), -field(0, i) / 2, 1e-5F) << i;
    }
}

TEST(VertexPropagationTest, FewVotesCountLessThanMany) {
    const Mesh mesh(kPlane);
    VertexField field;
    const Vector2d at = mesh.Vertex(5, 16);
    const std::vector<PointMotion> points(6, {at, {9, 3}});
    PropagateToVertices(mesh, points, {.shrink_votes = 3}, field);
    EXPECT_TRUE(field.col(Mesh::Index(5, 16)).isApprox(Vector2f{6, 2}));
}

TEST(VertexPropagationTest, AMinorityOfMoversDoesNotMoveAnyVertex) {
    const Mesh mesh(kPlane);
    std::vector<PointMotion> points = Everywhere({0, 0});
    cv::RNG random(1);
    for (PointMotion& point : points) {
        if (random.uniform(0.0, 1.0) < 0.3) point.motion_px = {15, -8};
    }
    VertexField field;
    PropagateToVertices(mesh, points, {}, field);
    EXPECT_LT(field.cwiseAbs().maxCoeff(), 1e-6F);
}

TEST(VertexPropagationTest, WithoutEnoughVotesAVertexStaysWhereItIs) {
    const Mesh mesh(kPlane);
    VertexField field = VertexField::Constant(7);
    VertexScalars votes = VertexScalars::Constant(7);
    PropagateToVertices(mesh, {}, {}, field, &votes);
    EXPECT_EQ(field, VertexField::Zero());
    EXPECT_EQ(votes, VertexScalars::Zero());

    const std::vector<PointMotion> two(2, {{320, 100}, {5, 5}});
    PropagateToVertices(mesh, two, {.min_votes = 3}, field, &votes);
    EXPECT_EQ(field, VertexField::Zero());
    EXPECT_EQ(votes.maxCoeff(), 2);
}

TEST(VertexPropagationTest, APointIsHeardInsideTheEllipseAndNowhereElse) {
    const Mesh mesh(kPlane);
    const Vector2d at{300, 90};
    const std::vector<PointMotion> points(5, {at, {1, 1}});
    const PropagationOptions options{.radius_px = {70, 45}};
    VertexField field;
    VertexScalars votes;
    PropagateToVertices(mesh, points, options, field, &votes);
    for (int row = 0; row < Mesh::kVertexRows; ++row) {
        for (int col = 0; col < Mesh::kVertexCols; ++col) {
            const Vector2d d = mesh.Vertex(row, col) - at;
            const bool inside = std::pow(d.x() / 70, 2) + std::pow(d.y() / 45, 2) <= 1;
            EXPECT_EQ(votes(Mesh::Index(row, col)), inside ? 5 : 0) << row << ' ' << col;
        }
    }
}

TEST(VertexPropagationTest, OneVertexThatDisagreesWithAllItsNeighboursIsFilteredAway) {
    const Mesh mesh(kPlane);
    std::vector<PointMotion> points;
    for (int i = 0; i < 10; ++i) points.push_back({mesh.Vertex(5, 10), {20, 20}});
    VertexField field;
    PropagateToVertices(mesh, points, {.radius_px = {5, 5}}, field);
    EXPECT_EQ(field, VertexField::Zero());
}

TEST(VertexPropagationTest, OnARingPointsAreHeardAcrossTheEdge) {
    const Mesh mesh(kRing);
    std::vector<PointMotion> points;
    for (double y = 0; y < 200; y += 5) points.push_back({{2, y}, {3, 1}});
    VertexField field;
    VertexScalars votes;
    PropagateToVertices(mesh, points, {.radius_px = {60, 60}}, field, &votes);
    EXPECT_GT(votes(Mesh::Index(5, Mesh::kCols - 2)), 3);
    EXPECT_GT(field(0, Mesh::Index(5, Mesh::kCols - 1)), 2);
    EXPECT_EQ(votes(Mesh::Index(5, Mesh::kCols / 2)), 0);
    for (int row = 0; row < Mesh::kVertexRows; ++row) {
        EXPECT_EQ(field.col(Mesh::Index(row, 0)), field.col(Mesh::Index(row, Mesh::kCols)));
    }

    PropagateToVertices(Mesh(kPlane), points, {.radius_px = {60, 60}}, field, &votes);
    EXPECT_EQ(votes(Mesh::Index(5, Mesh::kCols)), 0) << "a plane has no wrap";
}

}  // namespace
}  // namespace hitchview::algo
