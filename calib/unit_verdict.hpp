#pragma once

#include <string>
#include <vector>

#include "calib/unit_solver.hpp"

namespace hitchview::calib {

/// Why a unit may not be driven with, for a person: what to do. Empty: it may. Each of
///  - a camera looks more than 45 degrees away from its session's yaw; where two look in each
///    other's direction, their pictures were swapped;
///  - something changed (see FindChanges);
///  - a camera has fewer than 20 corners that fit;
///  - corners of a camera are off by more than 1 px (root mean square), or a sighting is an outlier
///    (see SightingOutcome);
///  - a surveyed corner is off by more than 5 standard deviations and 5 mm, or a measured pose by 5
///    standard deviations;
///  - a standard deviation is larger than 0.05 degrees or 5 mm.
std::vector<std::string> JudgeUnit(const UnitProblem& problem, const CameraGraph& graph,
                                   const UnitSolution& solution);

/// What it is judged by, for a file.
std::string UnitLimits();

}  // namespace hitchview::calib
