#pragma once

#include "calib/rig_calibration.hpp"
#include "drivers/simulated_rig.hpp"

namespace hitchview::app {

/// This geometry as a calibration of its cameras.
calib::RigCalibration CalibrationOf(const drivers::SimulatedRigGeometryTable& cameras);
/// The simulated rig's own geometry, with the errors that its options ask for.
calib::RigCalibration CalibrationOf(const drivers::SimulatedRig& rig);

}  // namespace hitchview::app
