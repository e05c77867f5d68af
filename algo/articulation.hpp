#pragma once

#include <optional>

#include "algo/feature_motion.hpp"
#include "algo/fixed_vector.hpp"
#include "algo/hinge_fit.hpp"
#include "algo/stabilization_motion_field.hpp"
#include "algo/unit.hpp"
#include "algo/unit_geometry.hpp"

namespace hitchview::algo {

/// Yaw of the trailer relative to the tractor at one moment, as the images tell it.
struct Articulation {
    double angle_rad = 0;  ///< positive to the left
    double sigma_rad = 0;  ///< standard deviation
    int inliers = 0;       ///< inter features that it was measured with; 0: predicted alone
};

struct ArticulationOptions {
    HingeFitOptions fit{};
    int min_inliers = 15;
    double min_share = 0.35;             ///< of the pairs that agree with a measurement
    double measured_sigma_rad = 0.03;    ///< a less certain fit is no measurement
    double reported_sigma_rad = 0.03;    ///< what is less certain is not reported
    double lost_sigma_rad = 0.1;         ///< what is less certain is searched from nothing
    double systematic_rad = 2e-3;        ///< of a measurement: what the calibration may be off
    double prediction_rad = 5e-3;        ///< deviation of the predicted turn between two frames
    double blind_prediction_rad = 0.02;  ///< same, where the intra motion of a unit is not known
    double gate = 4;       ///< measurements farther off, in deviations, are taken for wrong
    int most_refused = 5;  ///< in a row; after these the filter is what was wrong
};

/// Follows the articulation of a ring rig with calibrated cameras: each frame set is measured by
/// the calibrated hinge alone (HingeEstimator) and joined to what the intra motions predict by a
/// filter with one state (Kalman, 1960). For reports: the panorama does not depend on it. Memory is
/// taken at construction. Thread: one.
class ArticulationEstimator {
 public:
    ArticulationEstimator(const UnitGeometry& tractor, const UnitGeometry& trailer,
                          const ArticulationOptions& options);

    /// One frame set: motion of both views since the one before, and what both units see now.
    /// Empty while the angle is not known well enough.
    std::optional<Articulation> Step(const PerUnit<IntraMotion>& intra,
                                     const PerOverlap<InterFeatures>& inter_features);
    void Reset() { state_.reset(); }

 private:
    struct State {
        double angle_rad;
        double variance;
        int refused = 0;
    };

    void Predict(const PerUnit<IntraMotion>& intra);
    void Gather(const PerOverlap<InterFeatures>& inter_features);
    [[nodiscard]] std::optional<HingeFit> Measure() const;
    bool Correct(const HingeFit& measured);

    PerUnit<UnitGeometry> geometry_;
    ArticulationOptions options_;
    HingeEstimator hinge_;
    FixedVector<SightPair, 2 * kMaxInterFeatures> pairs_;
    std::optional<State> state_;
};

}  // namespace hitchview::algo
