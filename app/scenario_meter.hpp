#pragma once

#include <nlohmann/json_fwd.hpp>
#include <optional>

#include "app/truth_coverage.hpp"
#include "app/truth_overlap.hpp"
#include "app/truth_path.hpp"
#include "app/truth_seam.hpp"

namespace hitchview::app {

/// Everything that is measured of one drive against the truth. Thread: one; frames in order.
class ScenarioMeter {
 public:
    ScenarioMeter(const drivers::SimulatedRig& rig, const RigGeometry& geometry);

    void Observe(const ShownPanorama& shown, const algo::ComposedMap& map);

    /// Mean misalignment in the strip beyond 10 m if it was looked at in this frame.
    [[nodiscard]] std::optional<double> StripError_px(int frame, algo::Overlap overlap) const;
    [[nodiscard]] nlohmann::json Figures() const;

 private:
    void ObserveWarp(const algo::ComposedMap& map);
    void ObserveCoverage(const ShownPanorama& shown, const algo::ComposedMap& map);
    void ObserveArticulation(int frame, const algo::Composition& composition);
    [[nodiscard]] double ArticulationRate_rad_s(int frame) const;

    const drivers::SimulatedRig& rig_;
    const RigGeometry& geometry_;
    TruthSight sight_;
    TruthPath path_;
    TruthOverlap overlap_;
    TruthCoverage coverage_;
    algo::PerOverlap<TruthSeam> seams_;
    algo::PerOverlap<FieldJump> jumps_;
    algo::PerUnit<long> folded_cells_;
    algo::PerUnit<double> least_cell_ratio_{{1, 1}};         ///< without the unit's turn
    algo::PerUnit<double> least_turned_cell_ratio_{{1, 1}};  ///< with it
    algo::PerUnit<double> least_view_ratio_{{1, 1}};
    double least_coverage_ = 1;         ///< of what the calibration covers with a straight vehicle
    double least_hinged_coverage_ = 1;  ///< of what it covers at the true articulation
    double articulation_squares_ = 0;
    double largest_articulation_error_rad_ = 0;
    int articulation_samples_ = 0;
    int frames_ = 0;
};

}  // namespace hitchview::app
