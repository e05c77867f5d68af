#include "app/simulated_geometry.hpp"

#include "app/truth_calibration.hpp"

namespace hitchview::app {
namespace {

/// As wide to its height as the rig file's default.
RigConfig ConfigOf(const drivers::SimulatedRig& rig, int canvas_width_px, int cameras) {
    RigConfig config;
    config.file = "simulated rig";
    config.canvas.projection = CanvasConfig::Projection::kCylinder;
    config.canvas.size_px = {canvas_width_px, canvas_width_px * 360 / 2048 / 2 * 2};
    for (int i = 0; i < cameras; ++i) {
        config.units[rig.camera(i).unit].cameras.push_back(
            {.name = std::string(rig.camera(i).name), .source = CameraConfig::Source::kSimulated});
    }
    return config;
}

}  // namespace

hal::Checked<RigGeometry> GeometryOf(const drivers::SimulatedRig& rig, int canvas_width_px,
                                     int cameras) {
    CameraFormats formats;
    for (int i = 0; i < cameras; ++i) formats[rig.camera(i).unit].push_back(rig.format());
    return MakeRigGeometry(ConfigOf(rig, canvas_width_px, cameras), CalibrationOf(rig), formats);
}

}  // namespace hitchview::app
