#pragma once

#include <nlohmann/json.hpp>
#include <string>

namespace hitchview::app {

/// Charts, as HTML, of parts of `series` of `Evaluate`.

/// Centre's x and y and the rotation, before and after. `unit`: series.units.<unit>.
std::string PathCharts(const nlohmann::json& unit, double rate_hz);

/// Shake by frequency, before and after, and where 1 Hz is.
std::string SpectrumChart(const nlohmann::json& unit);

/// Mean and 95th percentile of each frame, both seams. `series`: all of them.
std::string SeamChart(const nlohmann::json& series);

/// Cropping, distortion and picture kept of both units, and the panorama's coverage.
std::string ViewCharts(const nlohmann::json& series);

}  // namespace hitchview::app
