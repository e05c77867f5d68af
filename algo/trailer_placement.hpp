#pragma once

#include <Eigen/Core>

#include "algo/feature_motion.hpp"
#include "algo/magsac.hpp"
#include "algo/projection.hpp"
#include "algo/stabilization_motion_field.hpp"
#include "algo/unit.hpp"

namespace hitchview::algo {

/// Alignment of the two units in one overlap.
enum class SeamState { kNoOverlap, kReacquire, kCoast, kLocked };

struct TrailerPlacementOptions {
    MagsacOptions robust{.max_sigma_px = 2.0, .max_iterations = 200};
    MagsacOptions acquire{.max_sigma_px = 4.0, .max_iterations = 500};
    double gain = 0.7;  ///< share of the newest measurement; more right after acquiring
    int min_inliers = 12;
    int acquire_inliers = 16;
    double acquire_share = 0.25;  ///< of the pairs that agree
    /// Bound of the pose, as a PoseOffset.
    Eigen::Vector3d wall = Eigen::Vector3d::Constant(1e9);
};

/// Where the trailer's view lies on the tractor's (docs/algorithm.md, section 7): the pose of rays,
/// tractor from trailer, of the raw views at each moment. Predicted by the intra motions of both
/// units, which carry the fast part exactly, and corrected by inter features with a gain. From
/// images alone. What would leave the wall stays at it: no vehicle bends so far.
class TrailerPlacement {
 public:
    TrailerPlacement(const Projection& tractor_view, const Projection& trailer_view,
                     const TrailerPlacementOptions& options);

    /// Before anything was matched.
    void Start(const Eigen::Matrix3d& M_tractor_trailer);
    /// Carries the pose over from the early to the late frame.
    void Predict(const PerUnit<IntraMotion>& intra);
    /// Corrects by the pairs of all overlaps at once: the trailer is one rigid body. `inliers`
    /// counts, per overlap, the pairs that agree with the pose; `false` if too few agree.
    bool Correct(const PerOverlap<InterFeatures>& inter_features);
    /// Replaces the pose by one fitted to unguided pairs; false if too few agree.
    bool Acquire(const PerOverlap<InterFeatures>& inter_features);

    [[nodiscard]] const Eigen::Matrix3d& M_tractor_trailer() const { return pose_; }
    [[nodiscard]] const PerOverlap<int>& inliers() const { return inliers_; }
    [[nodiscard]] bool acquired() const { return acquired_; }

    /// True if a pair agrees with the pose to `limit_px` of the tractor's view.
    [[nodiscard]] bool Agrees(const InterFeature& feature, double limit_px) const;

 private:
    std::optional<MagsacFit> Fit(const PerOverlap<InterFeatures>& inter_features, bool acquire);
    [[nodiscard]] bool IsWithinWall(const Eigen::Matrix3d& pose) const;
    void KeepWithinWall();
    void CountInliers(const PerOverlap<InterFeatures>& inter_features, double limit_px);

    Projection tractor_view_;
    Projection trailer_view_;
    TrailerPlacementOptions options_;
    static constexpr std::size_t kCapacity = 2 * kMaxInterFeatures;
    MagsacEstimator<SimilarityModel, kCapacity> similarity_;
    MagsacEstimator<RotationModel, kCapacity> rotation_;
    MagsacEstimator<SimilarityModel, kCapacity> acquire_similarity_;
    MagsacEstimator<RotationModel, kCapacity> acquire_rotation_;
    FixedVector<RayPair, kCapacity> pairs_;

    Eigen::Matrix3d pose_ = Eigen::Matrix3d::Identity();
    PerOverlap<int> inliers_;
    bool acquired_ = false;
    int frames_since_acquired_ = 0;
};

}  // namespace hitchview::algo
