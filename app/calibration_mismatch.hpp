#pragma once

#include <optional>
#include <vector>

#include "app/config.hpp"
#include "hal/event.hpp"

namespace hitchview::app {

/// What does not fit between a rig and its calibration and does not keep the rig from being
/// driven: a calibration whose verdict is fail, and cameras that it has and the rig has not. For
/// the moment when the program is ready.
std::vector<hal::Event> CalibrationMismatches(
    const RigConfig& config, const std::optional<calib::RigCalibration>& calibration,
    hal::Instant now);

/// The event of a rig that cannot be driven with its calibration. `why`: as the program says it.
hal::Event CalibrationRefused(const std::string& why, hal::Instant now);

}  // namespace hitchview::app
