#include "app/calibration_mismatch.hpp"

#include <algorithm>

namespace hitchview::app {
namespace {

using hal::EventText;

bool HasCamera(const RigConfig& config, const std::string& name) {
    return std::ranges::any_of(algo::kUnits, [&](algo::Unit unit) {
        return std::ranges::any_of(config.units[unit].cameras,
                                   [&](const CameraConfig& camera) { return camera.name == name; });
    });
}

hal::Event Mismatch(std::string_view subject, const EventText& text, hal::Instant now) {
    return {.code = hal::EventCode::kCalibrationMismatch,
            .when = now,
            .subject = subject,
            .text = text};
}

}  // namespace

std::vector<hal::Event> CalibrationMismatches(
    const RigConfig& config, const std::optional<calib::RigCalibration>& calibration,
    hal::Instant now) {
    std::vector<hal::Event> events;
    if (!calibration) return events;
    if (calibration->verdict == calib::Verdict::kFail)
        events.push_back(Mismatch("", {"the calibration's own verdict is fail"}, now));
    for (const auto& [name, camera] : calibration->cameras) {
        if (HasCamera(config, name)) continue;
        events.push_back(Mismatch(name, {"calibrated, and not in the rig file"}, now));
    }
    return events;
}

hal::Event CalibrationRefused(const std::string& why, hal::Instant now) {
    return Mismatch("", EventText(why), now);
}

}  // namespace hitchview::app
