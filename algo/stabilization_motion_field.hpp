#pragma once

#include "algo/feature_motion.hpp"
#include "algo/magsac.hpp"
#include "algo/mesh.hpp"
#include "algo/projection.hpp"
#include "algo/turn_fit.hpp"
#include "algo/vertex_propagation.hpp"

namespace hitchview::algo {

/// Motion of one view between two frames.
struct IntraMotion {
    /// Global motion: pose on rays of the view, late from early. A similarity or a rotation.
    Eigen::Matrix3d M_late_early = Eigen::Matrix3d::Identity();
    /// What the global motion leaves, at the vertices; px of the view.
    VertexField residual = VertexField::Zero();
    int inliers = 0;
    bool known = false;  ///< false: too few features agree; the motion is taken to be none
};

struct StabilizationMotionFieldOptions {
    MagsacOptions robust{.max_sigma_px = 1.0, .max_iterations = 150};
    int min_inliers = 12;
    double max_residual_px = 3;  ///< farther off is another motion, not a local one
    PropagationOptions propagation{};
    TurnFitOptions turn{};  ///< of a ring; px as those of the view
};

/// Stabilization motion field of one unit (paper, same section): feature motions into global motion
/// and residual motion; the residual to the vertices. The global model is what a shaking rigid unit
/// does to its picture: a similarity on the plane, a rotation of all rays on the ring (a homography
/// fits neither better: it follows noise on the plane and is no motion of a cylinder).
class StabilizationMotionField {
 public:
    StabilizationMotionField(const Projection& view,
                             const StabilizationMotionFieldOptions& options);

    /// `sights`: on a ring, the features as their cameras see them. They refine the global motion
    /// to what the unit turned by; without them it is the rotation that most features agree with.
    void Estimate(const FeatureMotions& intra_features, std::span<const SightMotion> sights,
                  IntraMotion& motion);
    void Reset() { turn_.Reset(); }

 private:
    void FitGlobal(const FeatureMotions& intra_features, IntraMotion& motion);
    void RefineTurn(std::span<const SightMotion> sights, IntraMotion& motion);
    void SpreadResiduals(const FeatureMotions& intra_features, IntraMotion& motion);

    Projection view_;
    Mesh mesh_;
    StabilizationMotionFieldOptions options_;
    MagsacEstimator<SimilarityModel, kMaxFeatures> similarity_;
    MagsacEstimator<RotationModel, kMaxFeatures> rotation_;
    TurnFit turn_;
    FixedVector<RayPair, kMaxFeatures> pairs_;
    FixedVector<PointMotion, kMaxFeatures> residuals_;
};

}  // namespace hitchview::algo
