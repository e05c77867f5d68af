#include "algo/trailer_placement.hpp"

#include <algorithm>

namespace hitchview::algo {

using Eigen::Matrix3d;
using Eigen::Vector2d;

TrailerPlacement::TrailerPlacement(const Projection& tractor_view, const Projection& trailer_view,
                                   const TrailerPlacementOptions& options)
    : tractor_view_(tractor_view),
      trailer_view_(trailer_view),
      options_(options),
      similarity_(options.robust),
      rotation_(options.robust),
      acquire_similarity_(options.acquire),
      acquire_rotation_(options.acquire) {}

void TrailerPlacement::Start(const Matrix3d& M_tractor_trailer) {
    pose_ = M_tractor_trailer;
    acquired_ = false;
    inliers_ = {};
}

void TrailerPlacement::Predict(const PerUnit<IntraMotion>& intra) {
    pose_ =
        intra[Unit::kTractor].M_late_early * pose_ * intra[Unit::kTrailer].M_late_early.inverse();
    KeepWithinWall();
    inliers_ = {};
}

std::optional<MagsacFit> TrailerPlacement::Fit(const PerOverlap<InterFeatures>& inter_features,
                                               bool acquire) {
    const bool ring = tractor_view_.IsRing();
    pairs_.clear();
    for (const Overlap overlap : kOverlaps) {
        for (const InterFeature& f : inter_features[overlap]) {
            const RayPair pair{trailer_view_.Ray(f.trailer_px), tractor_view_.Ray(f.tractor_px)};
            pairs_.push_back(ring ? RayPair{pair.from.normalized(), pair.to.normalized()} : pair);
        }
    }
    const double scale = tractor_view_.focal_px;
    if (acquire)
        return ring ? acquire_rotation_.Fit(pairs_, scale) : acquire_similarity_.Fit(pairs_);
    return ring ? rotation_.Fit(pairs_, scale) : similarity_.Fit(pairs_);
}

bool TrailerPlacement::Correct(const PerOverlap<InterFeatures>& inter_features) {
    const auto fit = Fit(inter_features, false);
    if (!fit || fit->inliers < options_.min_inliers) return false;
    const double gain =
        std::max(options_.gain, 1.0 / (1 + std::max(0, ++frames_since_acquired_ - 2)));
    const Matrix3d correction = fit->model * pose_.inverse();
    if (tractor_view_.IsRing()) {
        const PoseOffset offset{gain * ToOffset(tractor_view_, correction).value};
        pose_ = ToPose(tractor_view_, offset) * pose_;
    } else {
        pose_ = (Matrix3d::Identity() + gain * (correction - Matrix3d::Identity())) * pose_;
    }
    KeepWithinWall();
    CountInliers(inter_features, 3 * options_.robust.max_sigma_px);
    return true;
}

bool TrailerPlacement::Acquire(const PerOverlap<InterFeatures>& inter_features) {
    const auto fit = Fit(inter_features, true);
    const double fewest =
        std::max<double>(options_.acquire_inliers, options_.acquire_share * pairs_.count());
    if (!fit || fit->inliers < fewest || !IsWithinWall(fit->model)) return false;
    pose_ = fit->model;
    acquired_ = true;
    frames_since_acquired_ = 0;
    CountInliers(inter_features, 3 * options_.acquire.max_sigma_px);
    return true;
}

bool TrailerPlacement::IsWithinWall(const Matrix3d& pose) const {
    const Eigen::Vector3d offset = ToOffset(tractor_view_, pose).value;
    return (offset.cwiseAbs().array() <= options_.wall.array()).all();
}

void TrailerPlacement::KeepWithinWall() {
    if (!tractor_view_.IsRing() || IsWithinWall(pose_)) return;
    const Eigen::Vector3d offset = ToOffset(tractor_view_, pose_).value;
    pose_ = ToPose(tractor_view_, {offset.cwiseMin(options_.wall).cwiseMax(-options_.wall)});
}

bool TrailerPlacement::Agrees(const InterFeature& feature, double limit_px) const {
    const Vector2d expected = tractor_view_.Pixel(pose_ * trailer_view_.Ray(feature.trailer_px));
    return tractor_view_.Difference(feature.tractor_px, expected).norm() <= limit_px;
}

void TrailerPlacement::CountInliers(const PerOverlap<InterFeatures>& inter_features,
                                    double limit_px) {
    for (const Overlap overlap : kOverlaps) {
        inliers_[overlap] = static_cast<int>(
            std::count_if(inter_features[overlap].begin(), inter_features[overlap].end(),
                          [&](const InterFeature& f) { return Agrees(f, limit_px); }));
    }
}

}  // namespace hitchview::algo
