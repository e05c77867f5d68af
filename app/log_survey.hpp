#pragma once

#include <atomic>

#include "app/config.hpp"

namespace hitchview::app {

/// Looks into the recordings of `config.log` for what the cameras with source kLog are: fills their
/// format, whether all frames are stamped, and the rig's period where nobody has said it. A CAN bus
/// with source kLog goes where the recordings have no CAN frame, with a word on stderr.
/// Reads as far as it needs, to the end only where a camera is missing. The error names the
/// camera, and what its channel has instead of frames. `stop`: set from outside, reading then
/// fails.
hal::Checked<hal::Done> SurveyLogs(RigConfig& config, const std::atomic<bool>& stop);

}  // namespace hitchview::app
