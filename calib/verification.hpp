#pragma once

#include <optional>
#include <string>
#include <vector>

#include "calib/panorama_holes.hpp"
#include "calib/unit_problem.hpp"

namespace hitchview::calib {

/// One question that fresh pictures answer about a calibration.
struct Check {
    std::string name{};
    double figure = 0;
    std::optional<double> limit{};  ///< largest good figure; empty: for information
    std::string unit{};             ///< of figure and limit
    bool ok = true;
    std::string reason{};  ///< of one that is not good, for a person: what to do
};

/// What fresh pictures of one unit say about its calibration.
/// `problem`: every camera has a measured pose, that of the calibration; every target moves.
/// `panorama_px_per_rad`: of the panorama in whose pixels neighbours are compared.
///  - each camera's boards through its lens: 1.5 px (root mean square of the worst view);
///  - each two cameras that see the same: .25 degrees between them;
///  - each camera: not turned against its neighbours since it was calibrated (ExplainByMoves);
///  - each camera of a unit with several: something that a neighbour sees, too, at all.
std::vector<Check> CheckUnit(const UnitProblem& problem, double panorama_px_per_rad);

/// Each seam: no column without a picture at the horizon; and the uncovered pixels.
std::vector<Check> CheckHoles(const std::vector<SeamHole>& holes);

}  // namespace hitchview::calib
