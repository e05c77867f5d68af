#pragma once

#include <vector>

#include "app/camera_device.hpp"

namespace hitchview::app {

/// Whether the devices are also streamed from, each for a moment, to measure their memory.
enum class CameraMeasure { kNo, kReadSpeed };

/// Every video device that captures, by number. Its pick is for the wish that names it, otherwise
/// for what a rig file leaves out. Changes no setting unless it measures, which it does only with
/// devices that are free. Rates of devices that take any size are those of the first wish's size.
std::vector<CameraDevice> ProbeCameras(const std::vector<CameraWish>& wishes,
                                       CameraMeasure measure);

}  // namespace hitchview::app
