#pragma once

#include <Eigen/Geometry>
#include <numbers>
#include <vector>

#include "algo/unit_geometry.hpp"

namespace hitchview::tests {

/// A camera that looks level in the direction of `heading_rad` (positive to the left), 1.5 m in
/// front of the hitch point in that direction.
inline algo::CameraGeometry LevelCamera(double heading_rad) {
    algo::CameraGeometry camera;
    camera.model = {.kind = algo::CameraModel::Kind::kKannalaBrandt4,
                    .width_px = 320,
                    .height_px = 200,
                    .fx_px = 150,
                    .fy_px = 150,
                    .cx_px = 159.5,
                    .cy_px = 99.5,
                    .distortion = {-0.01, 0.002, 0, 0},
                    .max_theta_rad = 1.5};
    Eigen::Matrix3d facing_forward;  // columns: the camera's right, down, optical axis
    facing_forward << 0, 0, 1, -1, 0, 0, 0, -1, 0;
    const Eigen::AngleAxisd heading(heading_rad, Eigen::Vector3d::UnitZ());
    camera.T_unit_camera.linear() = heading.toRotationMatrix() * facing_forward;
    camera.T_unit_camera.translation() = heading * Eigen::Vector3d{1.5, 0, 1.0};
    return camera;
}

/// `count` cameras side by side, `apart_rad` from one to the next, the middle one facing
/// `facing_rad`.
inline std::vector<algo::CameraGeometry> LevelCameras(int count, double apart_rad,
                                                      double facing_rad) {
    std::vector<algo::CameraGeometry> cameras;
    for (int i = 0; i < count; ++i) {
        cameras.push_back(LevelCamera(facing_rad + apart_rad * (0.5 * (count - 1) - i)));
    }
    return cameras;
}

}  // namespace hitchview::tests
