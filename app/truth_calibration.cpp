#include "app/truth_calibration.hpp"

namespace hitchview::app {

calib::RigCalibration CalibrationOf(const drivers::SimulatedRigGeometryTable& cameras) {
    calib::RigCalibration calibration;
    calibration.vehicle = "simulated tractor-trailer, 4.5 x 1.5 x 1.8 m";
    calibration.verdict = calib::Verdict::kPass;
    calibration.written_by = "hitchview, from the simulation's own geometry";
    for (const drivers::SimulatedCameraGeometry& camera : cameras) {
        calibration.cameras[std::string(camera.name)] =
            calib::CalibratedCamera::From(camera.unit, camera.geometry);
    }
    return calibration;
}

calib::RigCalibration CalibrationOf(const drivers::SimulatedRig& rig) {
    const hal::FrameFormat format = rig.format();
    return CalibrationOf(
        drivers::Miscalibrated(drivers::SimulatedRigGeometry(format.width_px, format.height_px),
                               rig.options().calibration));
}

}  // namespace hitchview::app
