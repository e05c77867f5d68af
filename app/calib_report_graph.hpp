#pragma once

#include <nlohmann/json.hpp>
#include <string>

namespace hitchview::app {

/// Which camera saw which target, and how well they agree. `sightings`: [{camera, target, rms_px,
/// kept, outlier}]. HTML.
std::string SightingGraph(const nlohmann::json& sightings);

}  // namespace hitchview::app
