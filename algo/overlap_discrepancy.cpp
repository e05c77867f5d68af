#include "algo/overlap_discrepancy.hpp"

#include <algorithm>

namespace hitchview::algo {
namespace {

bool NeighboursHeard(const Mesh& mesh, const VertexScalars& votes, int row, int col, float fewest) {
    for (int r = std::max(row - 1, 0); r <= std::min(row + 1, Mesh::kRows); ++r) {
        for (int c = col - 1; c <= col + 1; ++c) {
            const int cc =
                mesh.ring ? (c + Mesh::kCols) % Mesh::kCols : std::clamp(c, 0, Mesh::kCols);
            if (votes(Mesh::Index(r, cc)) < fewest) return false;
        }
    }
    return true;
}

}  // namespace

MeasuredDiscrepancy MeasureDiscrepancy(const Projection& canvas, const CanvasPairs& pairs,
                                       double kappa, const PropagationOptions& propagation) {
    FixedVector<PointMotion, kMaxCanvasPairs> points;
    for (const CanvasPair& pair : pairs) {
        const Eigen::Vector2d e = canvas.Difference(pair.trailer_px, pair.tractor_px);
        points.push_back({pair.tractor_px + kappa * e, e});
    }
    const Mesh mesh(canvas);
    PropagationOptions whole = propagation;
    whole.shrink_votes = 0;  // few votes are less confidence, not a smaller motion
    MeasuredDiscrepancy measured;
    VertexScalars votes;
    PropagateToVertices(mesh, {points.data(), points.size()}, whole, measured.field, &votes);
    const auto fewest = static_cast<float>(propagation.min_votes);
    const auto half = static_cast<float>(propagation.shrink_votes);
    for (int row = 0; row < Mesh::kVertexRows; ++row) {
        for (int col = 0; col < Mesh::kVertexCols; ++col) {
            const int i = Mesh::Index(row, col);
            if (NeighboursHeard(mesh, votes, row, col, fewest))
                measured.confidence(i) = votes(i) / (votes(i) + half);
        }
    }
    return measured;
}

}  // namespace hitchview::algo
