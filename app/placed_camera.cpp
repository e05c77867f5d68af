#include "app/placed_camera.hpp"

namespace hitchview::app {

std::vector<PlacedCamera> CamerasOf(const RigConfig& config) {
    std::vector<PlacedCamera> cameras;
    for (const algo::Unit unit : algo::kUnits) {
        for (std::size_t i = 0; i < config.units[unit].cameras.size(); ++i)
            cameras.push_back({&config.units[unit].cameras[i], unit, i});
    }
    return cameras;
}

std::string CameraError(const RigConfig& config, const CameraConfig& camera,
                        const std::string& why) {
    return config.file.string() + ": camera " + camera.name + ": " + why;
}

}  // namespace hitchview::app
