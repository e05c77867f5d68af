#pragma once

#include <nlohmann/json_fwd.hpp>
#include <optional>
#include <string>
#include <vector>

#include "app/pipeline.hpp"
#include "app/truth_sight.hpp"
#include "drivers/simulated_rig.hpp"

namespace hitchview::app {

/// Measures panoramas of the simulated rig against what is true, from the map that was rendered:
///   shake  far landmarks, second difference of where the canvas shows them over three frame sets,
///          root mean square; beside it the same in each unit's own view, as it was taken
///   seam   scene points on the seam that both units see: distance between the places where the
///          canvas would show them from one and from the other unit
///   articulation  what the composition says against the yaw between the units, shake included
/// Thread: the run loop's.
class TruthMeter {
 public:
    TruthMeter(const drivers::SimulatedRig& rig, const RigGeometry& geometry);

    void Observe(const ShownPanorama& shown, const Pipeline& pipeline);

    struct Shake {
        double input_px = 0;  ///< px of the canvas
        double output_px = 0;
        int samples = 0;
    };
    struct Seam {
        double median_px = 0;
        double p95_px = 0;
        int samples = 0;
    };
    struct ArticulationError {
        double rms_rad = 0;
        double largest_rad = 0;
        int samples = 0;  ///< panoramas at which it was known
    };
    [[nodiscard]] Shake ShakeOf(algo::Unit unit) const;
    /// Over both overlaps, of points between the two distances from the camera.
    [[nodiscard]] Seam SeamOf(double from_m, double to_m) const;
    [[nodiscard]] ArticulationError ErrorOfArticulation() const;

 private:
    static constexpr int kLandmarks = 24;

    using Sightings = std::array<Sighting, kLandmarks>;
    struct SeamSample {
        double distance_m;
        double error_px;
    };

    void ObserveShake(algo::Unit unit, int frame, const algo::Composition& composition);
    void ObserveArticulation(int frame, const algo::Composition& composition);
    void ObserveSeam(algo::Overlap overlap, int frame, const ShownPanorama& shown,
                     const Pipeline& pipeline);

    TruthSight sight_;
    std::array<Eigen::Vector3d, kLandmarks> landmarks_;
    algo::PerUnit<std::array<Sightings, 3>> sightings_;  // newest first
    algo::PerUnit<double> input_squares_;
    algo::PerUnit<double> output_squares_;
    algo::PerUnit<int> shake_samples_;
    std::vector<SeamSample> seam_;
    double articulation_squares_ = 0;
    ArticulationError articulation_;
};

}  // namespace hitchview::app
