#pragma once

#include <atomic>
#include <filesystem>
#include <string>
#include <vector>

#include "app/config.hpp"

namespace hitchview::app {

/// What of a recording is to be replayed.
struct LogRigOptions {
    std::vector<std::filesystem::path> logs{};  ///< files and folders of segments, in order
    std::filesystem::path rig{};                ///< rig file instead of the recording's own
    std::string from{};  ///< seconds since its start, or 2026-11-22T19:51:39.5Z; empty: all
    std::string to{};    ///< same
};

/// The rig of a recording, ready to be opened: its cameras and its CAN bus are the recording's
/// channels, whatever the rig file names as their sources. Rig file and calibration are those that
/// the recording has, unless `rig` says otherwise. The error says what is missing or wrong: see
/// LoadRigConfig, LoadCalibrationFor and ResolveLogs. `stop`: set from outside, reading then fails.
hal::Checked<RigConfig> LoadLogRig(const LogRigOptions& options, const std::atomic<bool>& stop);

/// The same rig where LCM logs (*.lcm) stand behind `replay:` of its cameras: each camera is the
/// log's channel of its name. Other rigs stay as they are. The error names logs that cannot be read
/// and cameras whose frames they do not have.
hal::Checked<RigConfig> ResolveLogs(const RigConfig& config, const std::atomic<bool>& stop);

}  // namespace hitchview::app
