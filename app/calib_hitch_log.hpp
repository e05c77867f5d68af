#pragma once

#include <filesystem>
#include <optional>
#include <vector>

#include "calib/angle_fit.hpp"
#include "hal/result.hpp"

namespace hitchview::app {

/// What a recording tells of the vehicle's hitch angle.
struct HitchLog {
    std::vector<calib::AnglePair> pairs{};
    /// As in the rig file of the recording (docs/can.md); empty where a DBC file has them.
    std::optional<double> factor_deg{};
    double offset_deg = 0;
};

/// Puts the articulation of each panorama beside the hitch angle at the same moment, between two
/// valid messages not more than 0.2 s apart. The error names the log that cannot be read, or what
/// is not in it.
hal::Checked<HitchLog> ReadHitchLog(const std::vector<std::filesystem::path>& logs);

}  // namespace hitchview::app
