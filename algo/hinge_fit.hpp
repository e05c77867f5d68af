#pragma once

#include <numbers>
#include <optional>
#include <span>

#include "algo/magsac.hpp"
#include "algo/unit_geometry.hpp"

namespace hitchview::algo {

/// One scene point as the two units see it at the same time.
struct SightPair {
    SightLine tractor;
    SightLine trailer;
};

struct HingeFitOptions {
    double least_noise_rad = 6e-4;   ///< of a direction: what matching cannot do better than
    double refine_noise_rad = 8e-3;  ///< assumed where a good start is known, shrinks to what fits
    double search_noise_rad = 0.02;  ///< same without a start: roll and pitch are in it
    double roll_pitch_rad = 0.015;   ///< play of the hinge, root mean square
    double slip_m = 0.03;            ///< same, of the hitch points against each other
    double largest_yaw_rad = 70 * std::numbers::pi / 180;  ///< the hinge turns no farther
    int search_steps = 71;
    int search_pairs = 160;  ///< at most so many are looked at in the search
    int iterations = 10;
};

struct HingeFit {
    double yaw_rad;    ///< of the trailer relative to the tractor, positive to the left
    double sigma_rad;  ///< standard deviation that the pairs and the play allow
    double noise_rad;  ///< of one direction, as the pairs agree
    int inliers;
    double mean_cost;  ///< 0: all pairs agree, 1: none
};

/// The articulation as the epipolar geometry of the calibrated hinge. With c the centre and f the
/// direction of a sight line, the trailer turned by R = Rz(yaw) Ry(pitch) Rx(roll) about a hitch
/// point that slipped by s,
///     b = R c_trailer + s - c_tractor,   e = f_tractor . (b x R f_trailer) = 0
/// at any distance of the scene. The residual is e over its deviation for a unit of noise in both
/// directions (Sampson), an angle:
///     r = e / sqrt(|b x R f_trailer|^2 + |f_tractor x b|^2 - 2 e^2)
/// Yaw is free; roll, pitch and slip are the play of the hinge: small unknowns with a deviation to
/// expect. Gauss-Newton with the weights of MAGSAC++, while the noise is taken to be less and less.
/// Takes no memory; the same pairs give the same answer. Thread-safe.
class HingeEstimator {
 public:
    explicit HingeEstimator(const HingeFitOptions& options);

    /// From a yaw that is right to a few degrees. Empty for fewer than 3 inliers.
    [[nodiscard]] std::optional<HingeFit> Refine(std::span<const SightPair> pairs,
                                                 double yaw_rad) const;
    /// From nothing: looks at yaws over the whole range, refines the best ones.
    [[nodiscard]] std::optional<HingeFit> Search(std::span<const SightPair> pairs) const;

 private:
    HingeFitOptions options_;
    MagsacCost robust_{1};
};

}  // namespace hitchview::algo
