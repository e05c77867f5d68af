#include "algo/stabilization_motion_field.hpp"

#include <optional>

namespace hitchview::algo {

using Eigen::Vector2d;

StabilizationMotionField::StabilizationMotionField(const Projection& view,
                                                   const StabilizationMotionFieldOptions& options)
    : view_(view),
      mesh_(view),
      options_(options),
      similarity_(options.robust),
      rotation_(options.robust),
      turn_(options.turn) {}

void StabilizationMotionField::Estimate(const FeatureMotions& intra_features,
                                        std::span<const SightMotion> sights, IntraMotion& motion) {
    FitGlobal(intra_features, motion);
    if (motion.known && !sights.empty()) RefineTurn(sights, motion);
    motion.residual.setZero();
    if (motion.known) SpreadResiduals(intra_features, motion);
}

void StabilizationMotionField::FitGlobal(const FeatureMotions& intra_features,
                                         IntraMotion& motion) {
    pairs_.clear();
    for (const FeatureMotion& f : intra_features) {
        const Eigen::Vector3d early = view_.Ray(f.early_px);
        const Eigen::Vector3d late = view_.Ray(f.late_px);
        pairs_.push_back(view_.IsRing() ? RayPair{early.normalized(), late.normalized()}
                                        : RayPair{early, late});
    }
    const std::optional<MagsacFit> fit =
        view_.IsRing() ? rotation_.Fit(pairs_, view_.focal_px) : similarity_.Fit(pairs_);
    motion.known = fit && fit->inliers >= options_.min_inliers;
    motion.inliers = fit ? fit->inliers : 0;
    motion.M_late_early = motion.known ? fit->model : Eigen::Matrix3d::Identity();
}

void StabilizationMotionField::RefineTurn(std::span<const SightMotion> sights,
                                          IntraMotion& motion) {
    const std::optional<Turn> turn = turn_.Fit(sights, motion.M_late_early);
    motion.known = turn && turn->inliers >= options_.min_inliers;
    motion.inliers = turn ? turn->inliers : 0;
    motion.M_late_early = motion.known ? turn->R_late_early : Eigen::Matrix3d::Identity();
}

void StabilizationMotionField::SpreadResiduals(const FeatureMotions& intra_features,
                                               IntraMotion& motion) {
    residuals_.clear();
    for (const FeatureMotion& f : intra_features) {
        const Vector2d global = view_.Pixel(motion.M_late_early * view_.Ray(f.early_px));
        const Vector2d residual = view_.Difference(f.late_px, global);
        if (residual.norm() <= options_.max_residual_px)
            residuals_.push_back({f.late_px, residual});
    }
    PropagateToVertices(mesh_, {residuals_.data(), residuals_.size()}, options_.propagation,
                        motion.residual);
}

}  // namespace hitchview::algo
