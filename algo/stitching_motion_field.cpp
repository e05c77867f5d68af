#include "algo/stitching_motion_field.hpp"

#include <algorithm>
#include <cmath>

namespace hitchview::algo {

using Eigen::Vector2d;
using Eigen::Vector2f;

namespace {

constexpr float kFollowed_px = 1.0F;  ///< steps of this size and above get the whole gain
constexpr float kNoiseGain = 0.2F;    ///< share of the gain for the smallest steps

}  // namespace

StitchingMotionField::StitchingMotionField(const Projection& canvas,
                                           const StitchingMotionFieldOptions& options)
    : canvas_(canvas), mesh_(canvas), options_(options), homography_(options.robust) {}

void StitchingMotionField::Reset() {
    field_.setZero();
    support_.setZero();
}

Vector2d StitchingMotionField::Discrepancy(const CanvasPair& pair) const {
    return canvas_.Difference(pair.trailer_px, pair.tractor_px);
}

Vector2d StitchingMotionField::MeetingPoint(const CanvasPair& pair) const {
    return pair.tractor_px + options_.kappa * Discrepancy(pair);
}

void StitchingMotionField::Carry(const Eigen::Matrix3d& M_early_late) {
    const VertexField early = field_;
    for (int row = 0; row < Mesh::kVertexRows; ++row) {
        for (int col = 0; col < Mesh::kVertexCols; ++col) {
            const Vector2d at = canvas_.Pixel(M_early_late * canvas_.Ray(mesh_.Vertex(row, col)));
            field_.col(Mesh::Index(row, col)) = Sample(mesh_, early, at).cast<float>();
        }
    }
}

void StitchingMotionField::Update(const CanvasPairs& pairs) {
    if (pairs.count() < options_.propagation.min_votes) return;
    FitDominantPlane(pairs);
    SpreadResiduals(pairs);
    Blend(pairs);
}

void StitchingMotionField::FitDominantPlane(const CanvasPairs& pairs) {
    plane_known_ = false;
    if (pairs.count() < options_.homography_inliers) return;
    plane_origin_ = pairs[0].tractor_px;
    pairs_.clear();
    for (const CanvasPair& pair : pairs) {
        const Vector2d from = canvas_.Difference(MeetingPoint(pair), plane_origin_);
        const Vector2d to = from + Discrepancy(pair);
        pairs_.push_back({from.homogeneous(), to.homogeneous()});
    }
    const auto fit = homography_.Fit(pairs_);
    if (!fit || fit->inliers < options_.homography_inliers) return;
    plane_known_ = true;
    H_plane_ = fit->model;
}

Vector2d StitchingMotionField::PlaneDiscrepancy(const Vector2d& at_px) const {
    if (!plane_known_) return Vector2d::Zero();
    const Vector2d at = canvas_.Difference(at_px, plane_origin_);
    return (H_plane_ * at.homogeneous()).hnormalized() - at;
}

void StitchingMotionField::SpreadResiduals(const CanvasPairs& pairs) {
    residuals_.clear();
    for (const CanvasPair& pair : pairs) {
        const Vector2d at = MeetingPoint(pair);
        residuals_.push_back({at, Discrepancy(pair) - PlaneDiscrepancy(at)});
    }
    PropagateToVertices(mesh_, {residuals_.data(), residuals_.size()}, options_.propagation,
                        residual_field_, &votes_);
}

void StitchingMotionField::Blend(const CanvasPairs&) {
    for (int row = 0; row < Mesh::kVertexRows; ++row) {
        for (int col = 0; col < Mesh::kVertexCols; ++col) {
            const int i = Mesh::Index(row, col);
            if (votes_(i) < static_cast<float>(options_.propagation.min_votes)) continue;
            const float support =
                votes_(i) / (votes_(i) + static_cast<float>(options_.propagation.shrink_votes));
            const Vector2d measured =
                PlaneDiscrepancy(mesh_.Vertex(row, col)) + residual_field_.col(i).cast<double>();
            if (!(measured.norm() < options_.max_discrepancy_px)) continue;
            const Vector2f innovation = measured.cast<float>() - field_.col(i);
            // Small steps are matching noise and are averaged; large ones are the scene's and
            // followed.
            const float gain = std::clamp(innovation.norm() / kFollowed_px, kNoiseGain, 1.0F) *
                               static_cast<float>(options_.gain) * support;
            field_.col(i) += gain * innovation;
            support_(i) = std::max(support_(i), support);
        }
    }
}

void StitchingMotionField::Extend() {
    CloseRing(mesh_, field_);
    const auto fade = static_cast<float>(options_.fade_per_cell);
    for (int sweep = 0; sweep < options_.sweeps; ++sweep) {
        for (int row = 0; row < Mesh::kVertexRows; ++row) {
            for (int col = 0; col < Mesh::kVertexCols; ++col) {
                const int i = Mesh::Index(row, col);
                if (support_(i) > 0) continue;
                const int left = mesh_.ring && col == 0 ? Mesh::kCols - 1 : std::max(col - 1, 0);
                const int right =
                    mesh_.ring && col == Mesh::kCols ? 1 : std::min(col + 1, Mesh::kCols);
                const Vector2f sum = field_.col(Mesh::Index(row, left)) +
                                     field_.col(Mesh::Index(row, right)) +
                                     field_.col(Mesh::Index(std::max(row - 1, 0), col)) +
                                     field_.col(Mesh::Index(std::min(row + 1, Mesh::kRows), col));
                field_.col(i) = sum / (4 + fade);
            }
        }
    }
    CloseRing(mesh_, field_);
    GuardFolds();
    support_ *= 0.8F;  // a vertex stays its own for a few frames without matches
    support_ = (support_.array() < 0.2F).select(0.0F, support_);
}

void StitchingMotionField::GuardFolds() {
    float steepest = 0;
    for (int row = 0; row < Mesh::kVertexRows; ++row) {
        for (int col = 0; col < Mesh::kVertexCols; ++col) {
            const int i = Mesh::Index(row, col);
            if (col < Mesh::kCols) {
                const Vector2f across = field_.col(i + 1) - field_.col(i);
                steepest = std::max(
                    steepest, across.cwiseAbs().maxCoeff() / static_cast<float>(mesh_.cell_px.x()));
            }
            if (row < Mesh::kRows) {
                const Vector2f down = field_.col(i + Mesh::kVertexCols) - field_.col(i);
                steepest = std::max(
                    steepest, down.cwiseAbs().maxCoeff() / static_cast<float>(mesh_.cell_px.y()));
            }
        }
    }
    const auto limit = static_cast<float>(options_.max_stretch);
    if (steepest > limit) field_ *= limit / steepest;
}

}  // namespace hitchview::algo
