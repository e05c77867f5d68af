#pragma once

#include "algo/profile_smoothing.hpp"
#include "algo/unit.hpp"

namespace hitchview::algo {

/// How stitching and stabilisation are brought together.
///   kLiteral    as the paper states it: stage 2 takes each unit's own stabilisation out of its
///               stitching profile, stage 3 finds nothing left to do, and what is rendered is
///               stitched but not stabilised.
///   kCorrected  only the difference of the two stabilisations is taken out of the stitching
///               profiles: both views stay aligned and move as smoothly as their mean.
enum class Coupling { kLiteral, kCorrected };

/// Profiles of one unit at points of the overlap; the columns of both units belong to the same
/// scene points, in pixels of one canvas.
struct OverlapProfiles {
    Profiles T;  ///< accumulated trajectory
    Profiles V;  ///< stitching offset. With a point seen at a by the tractor and at b by the
                 ///< trailer: kappa (b - a) of the tractor, (1 - kappa) (a - b) of the trailer
};

struct PaperStagesOptions {
    ProfileSmoothingOptions smoothing{};
    double beta = 1;     ///< weight of stitching in stage 3
    int rounds = 3;      ///< of stages 2 and 3 in turn
    double kappa = 0.5;  ///< kCorrected: who moves, 0 the trailer alone, 1 the tractor alone
    double mu = 0;       ///< kCorrected: smoothness of the stitching profiles in time
};

/// What the stages found for one unit; shapes as OverlapProfiles.
struct OptimizedProfiles {
    Profiles T_hat;
    Profiles V_hat;

    /// Warp of the unit: source pixel p is shown at p + w(p).
    [[nodiscard]] Profiles Warp(const Profiles& T) const { return T_hat - T + V_hat; }
};

/// Solves (C + 2 mu L) x = C U for every column, C = diag(confidence of the column): follows U
/// where it is known and bridges the frames where it is not. `confidence`: 0..1, shape of U; a
/// column without any is zero. mu = 0: U where there is confidence, zero elsewhere.
Profiles SmoothByConfidence(const Profiles& U, const Profiles& confidence, double mu,
                            int radius_frames);

/// The three stages (paper, same section): 1 stabilise each unit alone; 2 stitching profiles for
/// fixed trajectories; 3 trajectories for fixed stitching profiles; 2 and 3 in turn.
/// `confidence` of the stitching profiles: 0..1, their shape; kCorrected only.
PerUnit<OptimizedProfiles> SolvePaperStages(const PerUnit<OverlapProfiles>& profiles,
                                            const Profiles& confidence, Coupling coupling,
                                            const PaperStagesOptions& options);

}  // namespace hitchview::algo
