#pragma once

#include <cstdint>
#include <filesystem>

#include "app/log_recording.hpp"
#include "hal/result.hpp"

namespace hitchview::app {

struct LogRepair {
    std::uint64_t events = 0;
    std::uint64_t bytes = 0;
};

/// Writes every whole event of the recording, numbered anew, to one log. `recording` is read from
/// its start. The error names the file and says why, and no file is left behind then.
hal::Checked<LogRepair> RepairLog(LogRecording& recording, const std::filesystem::path& out);

}  // namespace hitchview::app
