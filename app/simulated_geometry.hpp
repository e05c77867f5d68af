#pragma once

#include "app/rig_geometry.hpp"
#include "drivers/simulated_rig.hpp"

namespace hitchview::app {

/// Canvas and units of the simulated rig for a ring of this width, with CalibrationOf as
/// calibration. `cameras`: the first so many of the rig; with 3 or fewer there is no trailer.
/// Error: a width that no canvas can have.
hal::Checked<RigGeometry> GeometryOf(const drivers::SimulatedRig& rig, int canvas_width_px,
                                     int cameras = drivers::SimulatedRig::kCameras);

}  // namespace hitchview::app
