#pragma once

#include <nlohmann/json.hpp>
#include <string>

namespace hitchview::app {

/// Cameras of a unit from above, forward to the right, and where each looks. `cameras`: those of
/// `unit`, with position_m and rpy_deg. HTML.
std::string PlanView(const nlohmann::json& cameras);

}  // namespace hitchview::app
