#include "app/scenario_meter.hpp"

#include <algorithm>
#include <cmath>
#include <nlohmann/json.hpp>
#include <numbers>

#include "app/truth_warp.hpp"

namespace hitchview::app {
namespace {

using algo::Overlap;
using algo::Unit;
using nlohmann::json;

/// Rays into the scene are dear, and neighbouring frames look alike.
constexpr int kOverlapEvery = 5;
/// Corners of the map from one corner of the warp's grid to the next.
constexpr int kWarpStep = 2;
constexpr double kDegree = std::numbers::pi / 180;
/// Faster turns are judged by the picture alone.
constexpr double kFastTurn_rad_s = 20 * kDegree;

json PathJson(const TruthPath::Shake& shake) {
    if (shake.samples == 0) return nullptr;
    return {{"input_px", shake.input_px},
            {"output_px", shake.output_px},
            {"left_percent",
             shake.input_px > 0 ? json(100 * shake.output_px / shake.input_px) : json()},
            {"largest_second_difference_px", shake.largest_px},
            {"samples", shake.samples}};
}

json SeamJson(const TruthSeam::Figures& seam, double period_s, double largest_jump_px) {
    const auto percent = [&](int frames) -> json {
        if (seam.frames_there == 0) return nullptr;
        return 100.0 * frames / seam.frames_there;
    };
    return {{"frames_there", seam.frames_there},
            {"locked_percent", percent(seam.frames_locked)},
            {"frames_locked_away", seam.frames_locked_away},
            {"appearances", seam.appearances},
            {"longest_wait_s", seam.longest_wait * period_s},
            {"largest_field_jump_px", largest_jump_px}};
}

}  // namespace

ScenarioMeter::ScenarioMeter(const drivers::SimulatedRig& rig, const RigGeometry& geometry)
    : rig_(rig),
      geometry_(geometry),
      sight_(rig, geometry),
      path_(sight_, 1 / std::chrono::duration<double>(rig.options().period).count()),
      overlap_(sight_),
      coverage_(geometry) {}

void ScenarioMeter::Observe(const ShownPanorama& shown, const algo::ComposedMap& map) {
    const int frame = static_cast<int>(shown.picture.header.sequence);
    algo::Composition used = *shown.composition;
    used.detail = map.shown_detail();
    path_.Observe(frame, used);
    if (frame % kOverlapEvery == 0) overlap_.Observe(shown, used, map);
    ObserveWarp(map);
    ObserveCoverage(shown, map);
    for (const Overlap overlap : algo::kOverlaps)
        jumps_[overlap].Observe(overlap, *shown.composition);
    ObserveArticulation(frame, *shown.composition);
    ++frames_;
}

void ScenarioMeter::ObserveWarp(const algo::ComposedMap& map) {
    algo::PerUnit<WarpGrid> warps;
    for (const Unit unit : algo::kUnits) warps[unit] = WarpOf(map, geometry_, unit, kWarpStep);
    for (const Unit unit : algo::kUnits) {
        const WarpGrid& warp = warps[unit];
        folded_cells_[unit] += FoldedCells(warp);
        const WarpGrid& other = warps[Other(unit)];
        const WarpGrid rest = WithoutTurn(warp, geometry_.canvas);
        least_cell_ratio_[unit] = std::min(least_cell_ratio_[unit], LeastCellRatio(rest, other));
        least_turned_cell_ratio_[unit] =
            std::min(least_turned_cell_ratio_[unit], LeastCellRatio(warp, other));
        least_view_ratio_[unit] = std::min(least_view_ratio_[unit], AffineRatio(warp));
    }
}

void ScenarioMeter::ObserveCoverage(const ShownPanorama& shown, const algo::ComposedMap& map) {
    const int frame = static_cast<int>(shown.picture.header.sequence);
    const std::uint32_t missing = shown.cameras_missing;
    const TruthCoverage::Reference& straight = coverage_.At(0, missing);
    least_coverage_ = std::min(least_coverage_, coverage_.ShareOf(map, straight, missing));
    const TruthCoverage::Reference& hinged = coverage_.At(rig_.HitchAngleAt(frame), missing);
    least_hinged_coverage_ =
        std::min(least_hinged_coverage_, coverage_.ShareOf(map, hinged, missing));
    for (const Overlap overlap : algo::kOverlaps)
        seams_[overlap].Observe(hinged.there[overlap], shown.composition->seams[overlap]);
}

void ScenarioMeter::ObserveArticulation(int frame, const algo::Composition& composition) {
    if (!composition.articulation || ArticulationRate_rad_s(frame) >= kFastTurn_rad_s) return;
    const double error_rad =
        std::abs(composition.articulation->angle_rad - rig_.ArticulationAt(frame));
    articulation_squares_ += error_rad * error_rad;
    largest_articulation_error_rad_ = std::max(largest_articulation_error_rad_, error_rad);
    ++articulation_samples_;
}

double ScenarioMeter::ArticulationRate_rad_s(int frame) const {
    const int late = std::min(frame + 1, rig_.options().frames - 1);
    const int early = std::max(frame - 1, 0);
    if (late == early) return 0;
    const std::chrono::duration<double> apart = rig_.options().period * (late - early);
    return std::abs(rig_.HitchAngleAt(late) - rig_.HitchAngleAt(early)) / apart.count();
}

std::optional<double> ScenarioMeter::StripError_px(int frame, Overlap overlap) const {
    if (frame % kOverlapEvery != 0) return std::nullopt;
    return overlap_.NewestStripError_px(overlap);
}

json ScenarioMeter::Figures() const {
    const double period_s = std::chrono::duration<double>(rig_.options().period).count();
    json figures = ToJson(overlap_.samples());
    figures["frames"] = frames_;
    for (const Unit unit : algo::kUnits) {
        const char* name = ToString(unit);
        figures["motion"][name] = PathJson(path_.ShakeOf(unit));
        figures["warp"][name] = {{"folded_cells", folded_cells_[unit]},
                                 {"least_cell_ratio", least_cell_ratio_[unit]},
                                 {"least_turned_cell_ratio", least_turned_cell_ratio_[unit]},
                                 {"least_view_ratio", least_view_ratio_[unit]}};
    }
    for (const Overlap overlap : algo::kOverlaps) {
        figures["seam"][ToString(overlap)] =
            SeamJson(seams_[overlap].figures(), period_s, jumps_[overlap].largest_px());
    }
    figures["coverage"] = {{"least_percent", 100 * least_coverage_},
                           {"least_percent_of_hinged", 100 * least_hinged_coverage_}};
    figures["articulation"] = {
        {"rms_deg", articulation_samples_ > 0
                        ? json(std::sqrt(articulation_squares_ / articulation_samples_) / kDegree)
                        : json()},
        {"largest_deg",
         articulation_samples_ > 0 ? json(largest_articulation_error_rad_ / kDegree) : json()},
        {"samples", articulation_samples_}};
    return figures;
}

}  // namespace hitchview::app
