#include "algo/overlap_discrepancy.hpp"

#include <algorithm>

namespace hitchview::algo {

using Eigen::Vector2d;

OverlapDiscrepancy::OverlapDiscrepancy(const Projection& canvas,
                                       const OverlapDiscrepancyOptions& options)
    : canvas_(canvas), mesh_(canvas), options_(options), homography_(options.robust) {
    options_.propagation.shrink_votes = 0;  // few votes are less confidence, not a smaller motion
}

OverlapDiscrepancy::Plane OverlapDiscrepancy::FitPlane(const CanvasPairs& pairs) {
    Plane plane;
    if (pairs.count() < options_.homography_inliers) return plane;
    plane.origin_px = pairs[0].tractor_px;
    FixedVector<RayPair, kMaxCanvasPairs> rays;
    for (const CanvasPair& pair : pairs) {
        const PointMotion gap = DiscrepancyOf(pair, canvas_, options_.kappa);
        const Vector2d from = canvas_.Difference(gap.at_px, plane.origin_px);
        const Vector2d to = from + gap.motion_px;
        rays.push_back({from.homogeneous(), to.homogeneous()});
    }
    const auto fit = homography_.Fit(rays);
    plane.known = fit && fit->inliers >= options_.homography_inliers;
    if (plane.known) plane.H = fit->model;
    return plane;
}

Vector2d OverlapDiscrepancy::GapOn(const Plane& plane, const Vector2d& at_px) const {
    if (!plane.known) return Vector2d::Zero();
    const Vector2d at = canvas_.Difference(at_px, plane.origin_px);
    return (plane.H * at.homogeneous()).hnormalized() - at;
}

bool OverlapDiscrepancy::AllNeighboursHeard(const VertexScalars& votes, int row, int col) const {
    const auto fewest = static_cast<float>(options_.propagation.min_votes);
    for (int r = std::max(row - 1, 0); r <= std::min(row + 1, Mesh::kRows); ++r) {
        for (int c = col - 1; c <= col + 1; ++c) {
            const int cc = std::clamp(mesh_.WrappedColumn(c), 0, Mesh::kCols);
            if (votes(Mesh::Index(r, cc)) < fewest) return false;
        }
    }
    return true;
}

void OverlapDiscrepancy::Measure(const CanvasPairs& pairs, MeasuredDiscrepancy& measured) {
    constexpr float kHalfBelievedVotes = 3;
    const Plane plane = FitPlane(pairs);
    FixedVector<PointMotion, kMaxCanvasPairs> residuals;
    for (const CanvasPair& pair : pairs) {
        const PointMotion gap = DiscrepancyOf(pair, canvas_, options_.kappa);
        residuals.push_back({gap.at_px, gap.motion_px - GapOn(plane, gap.at_px)});
    }
    VertexField residual;
    VertexScalars votes;
    PropagateToVertices(mesh_, {residuals.data(), residuals.size()}, options_.propagation, residual,
                        &votes);
    for (int row = 0; row < Mesh::kVertexRows; ++row) {
        for (int col = 0; col < Mesh::kVertexCols; ++col) {
            const int i = Mesh::Index(row, col);
            const float confidence = votes(i) / (votes(i) + kHalfBelievedVotes);
            // At the rim the median over the neighbours is of what no one measured.
            if (confidence <= measured.confidence(i) || !AllNeighboursHeard(votes, row, col))
                continue;
            measured.confidence(i) = confidence;
            measured.field.col(i) =
                residual.col(i) + GapOn(plane, mesh_.Vertex(row, col)).cast<float>();
        }
    }
}

}  // namespace hitchview::algo
