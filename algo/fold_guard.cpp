#include "algo/fold_guard.hpp"

#include <algorithm>

namespace hitchview::algo {
namespace {

using Eigen::Vector2f;

/// Rounds of easing steep edges one by one.
constexpr int kEasingRounds = 12;
/// Excess over the limit that is not worth a round, as a share of the limit.
constexpr float kTolerated = 0.02F;

/// Calls visit(a, b, length_px) for the vertices of every edge, along each row first.
template <typename Visit>
void VisitEdges(const Mesh& mesh, Visit&& visit) {
    const Vector2f length_px = mesh.cell_px.cast<float>();
    for (int row = 0; row < Mesh::kVertexRows; ++row) {
        for (int col = 0; col < Mesh::kVertexCols; ++col) {
            const int i = Mesh::Index(row, col);
            if (col < Mesh::kCols) visit(i, i + 1, length_px.x());
            if (row < Mesh::kRows) visit(i, i + Mesh::kVertexCols, length_px.y());
        }
    }
}

/// Draws the ends of a steep edge together; false if it was not steep.
bool EaseEdge(int a, int b, float limit_px, VertexField& field) {
    const Vector2f difference = field.col(b) - field.col(a);
    const Vector2f excess = difference - difference.cwiseMin(limit_px).cwiseMax(-limit_px);
    if (excess.cwiseAbs().maxCoeff() <= kTolerated * limit_px) return false;
    field.col(a) += 0.5F * excess;
    field.col(b) -= 0.5F * excess;
    return true;
}

bool EaseAll(const Mesh& mesh, float limit, VertexField& field) {
    bool any = false;
    VisitEdges(mesh, [&](int a, int b, float length_px) {
        any = EaseEdge(a, b, limit * length_px, field) || any;
    });
    return any;
}

float Steepest(const Mesh& mesh, const VertexField& field) {
    float steepest = 0;
    VisitEdges(mesh, [&](int a, int b, float length_px) {
        const float change = (field.col(b) - field.col(a)).cwiseAbs().maxCoeff();
        steepest = std::max(steepest, change / length_px);
    });
    return steepest;
}

}  // namespace

void GuardFolds(const Mesh& mesh, double max_stretch, VertexField& field) {
    const auto limit = static_cast<float>(max_stretch);
    for (int round = 0; round < kEasingRounds; ++round) {
        if (!EaseAll(mesh, limit, field)) break;
        CloseRing(mesh, field);
    }
    const float steepest = Steepest(mesh, field);
    if (steepest > limit) field *= limit / steepest;
}

}  // namespace hitchview::algo
