#pragma once

#include <nlohmann/json.hpp>
#include <string>
#include <vector>

#include "app/calib_hitch_log.hpp"
#include "calib/hitch_solver.hpp"

namespace hitchview::app {

using Reasons = std::vector<std::string>;

/// All figures of a hitch point (docs/calibration-units.md), and the same for a person on stdout.
nlohmann::json HitchJson(const calib::HitchSolution& solution, const Reasons& reasons);
void PrintHitch(const calib::HitchSolution& solution, const Reasons& reasons);

/// The same of a sensor's factor and offset; for a person with the lines for the rig file.
nlohmann::json AngleJson(const calib::AngleFit& fit, const HitchLog& log, const Reasons& reasons);
void PrintAngles(const calib::AngleFit& fit, const HitchLog& log, const Reasons& reasons);

}  // namespace hitchview::app
