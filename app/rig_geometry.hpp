#pragma once

#include <optional>

#include "algo/projection.hpp"
#include "algo/unit_geometry.hpp"
#include "app/config.hpp"
#include "hal/frame.hpp"

namespace hitchview::app {

/// What the estimation and the renderer need to know of the rig.
struct RigGeometry {
    algo::Projection canvas;
    algo::PerUnit<std::optional<algo::UnitGeometry>> units;
};

/// Formats of the opened cameras, by unit and camera.
using CameraFormats = algo::PerUnit<std::vector<hal::FrameFormat>>;

/// From the configuration, the calibration (cylinder only) and the formats the cameras deliver.
/// Error: a camera delivers another size than it is calibrated for.
hal::Checked<RigGeometry> MakeRigGeometry(const RigConfig& config,
                                          const std::optional<calib::RigCalibration>& calibration,
                                          const CameraFormats& formats);

}  // namespace hitchview::app
