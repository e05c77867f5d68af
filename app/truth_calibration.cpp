#include "app/truth_calibration.hpp"

namespace hitchview::app {

calib::RigCalibration CalibrationOf(const drivers::SimulatedRig& rig) {
    calib::RigCalibration calibration;
    calibration.vehicle = "simulated tractor-trailer, 4.5 x 1.5 x 1.8 m";
    calibration.verdict = calib::Verdict::kPass;
    calibration.written_by = "hitchview, from the simulation's own geometry";
    for (int i = 0; i < drivers::SimulatedRig::kCameras; ++i) {
        const drivers::SimulatedCameraGeometry& camera = rig.camera(i);
        calibration.cameras[std::string(camera.name)] =
            calib::CalibratedCamera::From(camera.unit, camera.geometry);
    }
    return calibration;
}

}  // namespace hitchview::app
