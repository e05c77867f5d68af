#pragma once

#include <libcamera/controls.h>

#include <vector>

#include "drivers/libcamera_camera.hpp"
#include "hal/result.hpp"

namespace hitchview::drivers {

/// The values to set, of the camera's own controls. The error names control, value and what is
/// allowed. Set-up only. Pure.
hal::Checked<libcamera::ControlList> PlanLibcameraControls(
    const libcamera::ControlInfoMap& controls, const std::vector<LibcameraControlWish>& wishes);

/// Adds the duration of a frame, at least and at most, where the camera has FrameDurationLimits and
/// `planned` does not set them. The error names the rates that it can do.
hal::Checked<hal::Done> PlanLibcameraRate(const libcamera::ControlInfoMap& controls, double rate_hz,
                                          libcamera::ControlList& planned);

}  // namespace hitchview::drivers
