#pragma once

#include <Eigen/Core>

#include "algo/banded_solver.hpp"

namespace hitchview::algo {

/// Vertex motion profiles (paper, same section) of a recording: row i belongs to frame i, each
/// column is one axis of one vertex; px.
using Profiles = Eigen::MatrixXd;

struct ProfileSmoothingOptions {
    int radius_frames = 10;  ///< r, the paper's sigma: half the temporal window
    double lambda = 1.2;     ///< the paper's lambda_t: smoothness against fidelity
};

/// w(d) = exp(-(3 d / r)^2) for |d| <= r, else 0: the paper's weight of two frames d apart.
double TemporalWeight(Eigen::Index distance_frames, int radius_frames);

/// Accumulated trajectory: T(i) = motion(0) + ... + motion(i). Intra motion alone: an inter motion
/// is a position, not a velocity.
Profiles AccumulateMotion(const Profiles& motion);

/// Matrix of the smoothness term: x' L x = sum over pairs i < j of w_ij weight (x_i - x_j)^2.
SymmetricBand SmoothnessMatrix(Eigen::Index frames, int radius_frames, double weight);

/// A of stage 1, A That = T: the gradient of
///     sum_i (x_i - T_i)^2 + lambda sum_i sum_{j in window} w_ij (x_i - x_j)^2.
/// The sum meets each pair twice, so A = I + 2 lambda L. Positive definite, an M-matrix with row
/// sums 1: constant profiles stay, and no result leaves the range of its profile.
SymmetricBand StabilizationMatrix(Eigen::Index frames, const ProfileSmoothingOptions& options);
/// With a lambda of its own for every frame: pair (i, j) weighs (lambda_i + lambda_j) w_ij, which
/// keeps A symmetric.
SymmetricBand StabilizationMatrix(const Eigen::Ref<const Eigen::VectorXd>& lambda,
                                  int radius_frames);

/// The paper's L_stab of one profile `x` against its trajectory `T`.
double StabilizationEnergy(const Eigen::Ref<const Eigen::VectorXd>& x,
                           const Eigen::Ref<const Eigen::VectorXd>& T,
                           const ProfileSmoothingOptions& options);

/// Stage 1: the smoothed trajectories That, which minimise the energy above for every column.
Profiles SmoothProfiles(const Profiles& T, const ProfileSmoothingOptions& options);

/// Share of a sine of `cycles_per_frame` that stage 1 keeps, far from both ends.
double SmoothingGain(double cycles_per_frame, const ProfileSmoothingOptions& options);

}  // namespace hitchview::algo
