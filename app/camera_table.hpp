#pragma once

#include <nlohmann/json_fwd.hpp>
#include <string>
#include <vector>

#include "app/camera_device.hpp"
#include "app/camera_match.hpp"

namespace hitchview::app {

/// How much of what a device offers is shown.
enum class CameraDetail {
    kBest,  ///< formats that are taken, of each a few sizes and rates
    kAll,
};

/// One row for each device, under it its lasting names, what it offers and why it was picked so, in
/// lines of at most 100 characters but for names, which are never broken. Characters of the
/// devices' own texts that a terminal might obey or misplace are shown as '?'. Without devices:
/// what to check.
std::string CameraTable(const std::vector<CameraDevice>& devices, CameraDetail detail);

/// One row for each camera of a rig file; what it lacks.
std::string MatchTable(const std::vector<CameraMatch>& matches);

/// Everything that is known, with every offer. Text that is not UTF-8 is made so.
nlohmann::json CamerasJson(const std::vector<CameraDevice>& devices);
nlohmann::json MatchesJson(const std::vector<CameraMatch>& matches);

}  // namespace hitchview::app
