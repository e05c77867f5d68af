#include <gtest/gtest.h>

#include <numbers>

#include "algo/mesh.hpp"

namespace hitchview::algo {
namespace {

using Eigen::Vector2d;
using Eigen::Vector2f;

const Projection kPlane = Projection::Plane(641, 201);
const Projection kRing = Projection::Cylinder(640, 200, 0.5);

template <typename Function>
VertexField FieldOf(const Mesh& mesh, Function&& function) {
    VertexField field;
    for (int row = 0; row < Mesh::kVertexRows; ++row) {
        for (int col = 0; col < Mesh::kVertexCols; ++col) {
            const Vector2d value = function(mesh.Vertex(row, col));
            field.col(Mesh::Index(row, col)) = value.cast<float>();
        }
    }
    return field;
}

TEST(MeshTest, ThePlanesVerticesReachItsOuterPixels) {
    const Mesh mesh(kPlane);
    EXPECT_EQ(mesh.Vertex(0, 0), Vector2d(0, 0));
    EXPECT_EQ(mesh.Vertex(Mesh::kRows, Mesh::kCols), Vector2d(640, 200));
}

TEST(MeshTest, SampleReproducesALinearFieldBetweenTheVertices) {
    const Mesh mesh(kPlane);
    const auto linear = [](const Vector2d& p) {
        return Vector2d{0.03 * p.x() - 0.02 * p.y() + 1, 0.01 * p.x() + 0.05 * p.y() - 4};
    };
    const VertexField field = FieldOf(mesh, linear);
    for (double x = 0; x <= 640; x += 13.7) {
        for (double y = 0; y <= 200; y += 9.1) {
            EXPECT_LT((Sample(mesh, field, {x, y}) - linear({x, y})).norm(), 1e-4) << x << ' ' << y;
        }
    }
}

TEST(MeshTest, OutsideAPlaneTheNearestEdgeCounts) {
    const Mesh mesh(kPlane);
    const VertexField field = FieldOf(mesh, [](const Vector2d& p) { return p; });
    EXPECT_LT((Sample(mesh, field, {-50, 120}) - Vector2d{0, 120}).norm(), 1e-3);
    EXPECT_LT((Sample(mesh, field, {900, 999}) - Vector2d{640, 200}).norm(), 1e-3);
}

TEST(MeshTest, ARingsFieldContinuesAcrossTheEdge) {
    const Mesh mesh(kRing);
    const VertexField field = FieldOf(mesh, [](const Vector2d& p) {
        const double angle = 2 * std::numbers::pi * (p.x() + 0.5) / 640;
        return Vector2d{std::cos(angle), std::sin(angle)};
    });
    for (double y = 0; y < 200; y += 31) {
        const Vector2d before = Sample(mesh, field, {639.499, y});
        const Vector2d after = Sample(mesh, field, {-0.499, y});
        EXPECT_LT((before - after).norm(), 1e-3);
        EXPECT_LT((Sample(mesh, field, {100, y}) - Sample(mesh, field, {740, y})).norm(), 1e-6);
    }
}

TEST(MeshTest, CloseRingMakesTheLastColumnTheFirstAndLeavesAPlaneAlone) {
    VertexField field = VertexField::Random();
    const VertexField before = field;
    CloseRing(Mesh(kPlane), field);
    EXPECT_EQ(field, before);
    CloseRing(Mesh(kRing), field);
    for (int row = 0; row < Mesh::kVertexRows; ++row) {
        EXPECT_EQ(field.col(Mesh::Index(row, Mesh::kCols)), before.col(Mesh::Index(row, 0)));
        EXPECT_EQ(field.col(Mesh::Index(row, 7)), before.col(Mesh::Index(row, 7)));
    }
}

}  // namespace
}  // namespace hitchview::algo
