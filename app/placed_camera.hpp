#pragma once

#include <string>
#include <vector>

#include "app/config.hpp"

namespace hitchview::app {

/// A camera of a rig and where it is.
struct PlacedCamera {
    const CameraConfig* config;  ///< of the rig's configuration, which must outlive it
    algo::Unit unit;
    std::size_t index_in_unit;
};

/// In the order of the bits of cameras_missing.
std::vector<PlacedCamera> CamerasOf(const RigConfig& config);

/// What is wrong with a camera, with the file that names it.
std::string CameraError(const RigConfig& config, const CameraConfig& camera,
                        const std::string& why);

}  // namespace hitchview::app
