#include "algo/warp_factor.hpp"

#include <array>

#include "algo/motion_models.hpp"

namespace hitchview::algo {
namespace {

using Eigen::Matrix3d;
using Eigen::Vector2d;

Matrix3d FitPose(const Projection& view, const VertexField& warp) {
    const Mesh mesh(view);
    std::array<RayPair, Mesh::kVertices> pairs;
    std::array<double, Mesh::kVertices> weights;
    for (int row = 0; row < Mesh::kVertexRows; ++row) {
        for (int col = 0; col < Mesh::kVertexCols; ++col) {
            const auto i = static_cast<std::size_t>(Mesh::Index(row, col));
            const Vector2d v = mesh.Vertex(row, col);
            const Vector2d moved = v + warp.col(Mesh::Index(row, col)).cast<double>();
            pairs[i] = {view.Ray(v), view.Ray(moved)};
            if (view.IsRing()) {
                pairs[i].from.normalize();
                pairs[i].to.normalize();
            }
            const bool again = view.IsRing() && col == Mesh::kCols;
            weights[i] = again ? 0 : 1;
        }
    }
    const auto pose =
        view.IsRing() ? RotationModel::Fit(pairs, weights) : SimilarityModel::Fit(pairs, weights);
    return pose.value_or(Matrix3d::Identity());
}

/// The rest by the pixels it starts from.
VertexField ForwardRest(const Projection& view, const VertexField& warp, const Matrix3d& pose) {
    const Mesh mesh(view);
    const Matrix3d back = pose.inverse();
    VertexField rest;
    for (int row = 0; row < Mesh::kVertexRows; ++row) {
        for (int col = 0; col < Mesh::kVertexCols; ++col) {
            const int i = Mesh::Index(row, col);
            const Vector2d v = mesh.Vertex(row, col);
            const Vector2d moved = v + warp.col(i).cast<double>();
            rest.col(i) = view.Difference(view.Pixel(back * view.Ray(moved)), v).cast<float>();
        }
    }
    return rest;
}

/// The same by the pixels it leads to: r(y) = rest(y - r(y)).
VertexField BackwardRest(const Projection& view, const VertexField& rest) {
    constexpr int kSteps = 6;
    const Mesh mesh(view);
    VertexField backward;
    for (int row = 0; row < Mesh::kVertexRows; ++row) {
        for (int col = 0; col < Mesh::kVertexCols; ++col) {
            const Vector2d v = mesh.Vertex(row, col);
            Vector2d r = Vector2d::Zero();
            for (int step = 0; step < kSteps; ++step) r = Sample(mesh, rest, v - r);
            backward.col(Mesh::Index(row, col)) = r.cast<float>();
        }
    }
    CloseRing(mesh, backward);
    return backward;
}

}  // namespace

FactoredWarp FactorWarp(const Projection& view, const VertexField& warp) {
    FactoredWarp factored;
    factored.pose = FitPose(view, warp);
    factored.rest = BackwardRest(view, ForwardRest(view, warp, factored.pose));
    return factored;
}

}  // namespace hitchview::algo
