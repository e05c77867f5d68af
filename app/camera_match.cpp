#include "app/camera_match.hpp"

#include <algorithm>
#include <filesystem>
#include <system_error>
#include <utility>

namespace hitchview::app {
namespace {

constexpr double kNanosecondsPerSecond = 1e9;

std::string ProblemOfMissing(const std::string& path) {
    std::error_code ignored;
    return std::filesystem::exists(path, ignored) ? "it is there, but is no camera"
                                                  : "nothing is there";
}

std::string ProblemOf(const CameraDevice& device) {
    if (!device.IsOpen()) return device.refusal + "; " + Remedy(device);
    const char* const separator = device.no_pick.empty() || device.unsettable.empty() ? "" : "; ";
    return device.no_pick + separator + device.unsettable;
}

const CameraMatch* FindOwner(const std::vector<CameraMatch>& matches, const std::string& device) {
    const auto owner = std::ranges::find(matches, device, &CameraMatch::device);
    return owner == matches.end() ? nullptr : &*owner;
}

CameraMatch Match(algo::Unit unit, const CameraConfig& camera,
                  const std::vector<CameraDevice>& devices,
                  const std::vector<CameraMatch>& earlier) {
    CameraMatch match{unit, camera.name, camera.live.device, "", "", true};
    if (camera.source == CameraConfig::Source::kLibcamera) {
        match.looked_for = false;
        return match;
    }
    const auto found = std::ranges::find_if(
        devices, [&](const CameraDevice& device) { return device.IsNamed(match.configured); });
    if (found == devices.end()) {
        match.problem = ProblemOfMissing(match.configured);
        return match;
    }
    match.device = found->path;
    const CameraMatch* const owner = FindOwner(earlier, match.device);
    match.problem = owner == nullptr ? ProblemOf(*found) : "camera " + owner->name + " has it";
    return match;
}

}  // namespace

std::vector<CameraWish> WishesOf(const RigConfig& rig) {
    const auto period = rig.period.value_or(kDefaultPeriod);
    const double rate_hz = kNanosecondsPerSecond / static_cast<double>(period.count());
    std::vector<CameraWish> wishes;
    for (const algo::Unit unit : algo::kUnits) {
        for (const CameraConfig& camera : rig.units[unit].cameras) {
            if (camera.source == CameraConfig::Source::kV4l2)
                wishes.push_back({camera.live, rate_hz});
        }
    }
    return wishes;
}

std::vector<CameraMatch> MatchCameras(const RigConfig& rig,
                                      const std::vector<CameraDevice>& devices) {
    std::vector<CameraMatch> matches;
    for (const algo::Unit unit : algo::kUnits) {
        for (const CameraConfig& camera : rig.units[unit].cameras) {
            if (!camera.IsLive()) continue;
            CameraMatch match = Match(unit, camera, devices, matches);
            matches.push_back(std::move(match));
        }
    }
    return matches;
}

bool AllThere(const std::vector<CameraMatch>& matches) {
    return std::ranges::all_of(matches, &std::string::empty, &CameraMatch::problem);
}

}  // namespace hitchview::app
