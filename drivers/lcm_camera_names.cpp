#include "drivers/lcm_camera_names.hpp"

#include <algorithm>

#include "drivers/lcm_logged_health.hpp"

namespace hitchview::drivers {
namespace {

constexpr std::size_t kMostCameras = 8;
constexpr std::size_t kLongestName = 63;

bool IsName(std::string_view name) {
    return name.size() <= kLongestName &&
           std::ranges::all_of(name, [](char letter) { return letter >= ' ' && letter <= '~'; });
}

}  // namespace

hal::Result<std::vector<std::string>> ParseCameraNames(std::span<const std::uint8_t> message) {
    const auto health = ParseLoggedHealth(message);
    if (!health) return health.error();
    if (health.value().cameras.size() > kMostCameras) return hal::Error::kCorrupted;
    std::vector<std::string> names;
    for (const LoggedCameraHealth& camera : health.value().cameras) {
        if (!IsName(camera.name)) return hal::Error::kCorrupted;
        names.emplace_back(camera.name);
    }
    return names;
}

}  // namespace hitchview::drivers
