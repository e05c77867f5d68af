// Writes the files of a simulated rig whose cameras drop out: web_simulated_rig FOLDER
// The left front camera of the tractor gives no frames from the third to the fourth second.

#include <fstream>
#include <string>

#include "calib/rig_calibration.hpp"
#include "drivers/simulated_rig.hpp"
#include "tests/support/simulated_rig_files.hpp"

int main(int argc, char** argv) {
    using namespace hitchview;
    if (argc != 2) return 2;
    const std::string folder = argv[1];
    calib::RigCalibration calibration{.vehicle = "simulated", .written_by = "test"};
    for (const auto& camera : drivers::SimulatedRigGeometry(320, 180)) {
        calibration.cameras[std::string(camera.name)] =
            calib::CalibratedCamera::From(camera.unit, camera.geometry);
    }
    if (!calib::SaveCalibration(calibration, folder + "/rig.calib.yaml").empty()) return 3;
    const auto simulated = [](const std::string&) { return "{simulated: true}"; };
    std::ofstream(folder + "/rig.yaml")
        << "schema: 1\n"
           "canvas: {projection: cylinder, size_px: [1024, 180]}\n"
           "calibration: rig.calib.yaml\n"
        << tests::SimulatedUnits(simulated)
        << "simulation: {scenario: camera_lost, frames: 150, camera_size_px: [320, 180]}\n";
    return 0;
}
