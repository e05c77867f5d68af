#include "app/rig_geometry.hpp"

#include <numbers>
#include <string>

namespace hitchview::app {
namespace {

std::string Size(int width, int height) {
    return std::to_string(width) + "x" + std::to_string(height);
}

hal::Checked<std::vector<algo::CameraGeometry>> CalibratedCameras(
    const RigConfig& config, const calib::RigCalibration& calibration, algo::Unit unit,
    const std::vector<hal::FrameFormat>& formats) {
    std::vector<algo::CameraGeometry> cameras;
    for (std::size_t i = 0; i < formats.size(); ++i) {
        const std::string& name = config.units[unit].cameras[i].name;
        const algo::CameraGeometry geometry = calibration.cameras.at(name).Geometry();
        if (geometry.model.width_px != formats[i].width_px ||
            geometry.model.height_px != formats[i].height_px) {
            return config.file.string() + ": camera " + name + " delivers " +
                   Size(formats[i].width_px, formats[i].height_px) + " px, must be " +
                   Size(geometry.model.width_px, geometry.model.height_px) + " as calibrated";
        }
        cameras.push_back(geometry);
    }
    return cameras;
}

}  // namespace

hal::Checked<RigGeometry> MakeRigGeometry(const RigConfig& config,
                                          const std::optional<calib::RigCalibration>& calibration,
                                          const CameraFormats& formats) {
    const CanvasConfig& canvas = config.canvas;
    RigGeometry rig;
    if (canvas.projection == CanvasConfig::Projection::kPlane) {
        rig.canvas = algo::Projection::Plane(canvas.size_px.width_px, canvas.size_px.height_px);
        for (const algo::Unit unit : algo::kUnits) {
            if (formats[unit].empty()) continue;
            rig.units[unit] =
                algo::UnitGeometry::Plane(formats[unit][0].width_px, formats[unit][0].height_px);
        }
        return rig;
    }
    rig.canvas = algo::Projection::Cylinder(canvas.size_px.width_px, canvas.size_px.height_px,
                                            canvas.horizon);
    const algo::AlignmentSurface surface{.radius_m = canvas.radius_m,
                                         .viewpoint_m = canvas.viewpoint_m,
                                         .ground_m = canvas.ground_m};
    for (const algo::Unit unit : algo::kUnits) {
        if (formats[unit].empty()) continue;
        auto cameras = CalibratedCameras(config, *calibration, unit, formats[unit]);
        if (!cameras) return cameras.error();
        // The trailer looks back: the middle of its view is the rear.
        const double centre = unit == algo::Unit::kTractor ? 0.0 : std::numbers::pi;
        const auto view = algo::Projection::Cylinder(
            canvas.size_px.width_px, canvas.size_px.height_px, canvas.horizon, centre);
        rig.units[unit] = algo::UnitGeometry::Ring(view, *cameras, surface);
    }
    return rig;
}

}  // namespace hitchview::app
