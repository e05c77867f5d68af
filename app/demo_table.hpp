#pragma once

#include <nlohmann/json_fwd.hpp>
#include <string>

namespace hitchview::app {

/// What is read first of the figures of ScenarioMeter: `before` with the fixed calibration, `after`
/// with everything; shake before is that of the cameras. A figure that is not known is a dash.
std::string DemoTable(const nlohmann::json& before, const nlohmann::json& after);

}  // namespace hitchview::app
