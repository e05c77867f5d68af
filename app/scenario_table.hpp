#pragma once

#include <nlohmann/json_fwd.hpp>
#include <string>

namespace hitchview::app {

/// What stands above the rows of ScenarioRow, with its measures.
std::string ScenarioHead();

/// The headline figures of one scenario (RunScenario) on one line. A figure that is not known: -.
std::string ScenarioRow(const std::string& name, const nlohmann::json& figures);

}  // namespace hitchview::app
