#pragma once

#include <string>

#include "app/config.hpp"
#include "drivers/libcamera_camera.hpp"
#include "drivers/v4l2_negotiation.hpp"

/// What a rig file says of a live camera, in the words of its driver.
namespace hitchview::app {

/// `name`: in the log. `buffers`: [2, 32].
drivers::V4l2CameraOptions V4l2OptionsOf(const std::string& name, const LiveCameraConfig& live,
                                         double rate_hz, int buffers);
drivers::LibcameraOptions LibcameraOptionsOf(const std::string& name, const LiveCameraConfig& live,
                                             double rate_hz, int buffers);

}  // namespace hitchview::app
