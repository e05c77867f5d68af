#pragma once

#include "calib/rig_calibration.hpp"
#include "drivers/simulated_rig.hpp"

namespace hitchview::app {

/// The simulated rig's own geometry as a calibration of its cameras.
calib::RigCalibration CalibrationOf(const drivers::SimulatedRigGeometryTable& cameras);
calib::RigCalibration CalibrationOf(const drivers::SimulatedRig& rig);

}  // namespace hitchview::app
