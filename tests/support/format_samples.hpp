#pragma once

#include <cmath>
#include <random>
#include <string>

#include "calib/lens_field.hpp"
#include "calib/rig_calibration.hpp"

namespace hitchview::tests {

/// Lenses and rigs with numbers that need all their digits.
class FormatSamples {
 public:
    explicit FormatSamples(unsigned seed) : random_(seed) {}

    double Between(double min, double max) {
        return std::uniform_real_distribution<double>(min, max)(random_);
    }

    algo::CameraModel Lens(algo::CameraModel::Kind kind) {
        const bool pinhole = kind == algo::CameraModel::Kind::kPinholeRadtan;
        const double focal_px = pinhole ? Between(700, 1200) : Between(320, 500);
        algo::CameraModel lens{.kind = kind,
                               .width_px = 1280,
                               .height_px = 720,
                               .fx_px = focal_px,
                               .fy_px = focal_px * Between(0.99, 1.01),
                               .cx_px = Between(600, 680),
                               .cy_px = Between(330, 390)};
        if (pinhole) {
            lens.distortion = {Between(-0.3, 0), Between(0, 0.1), Between(-1e-3, 1e-3),
                               Between(-1e-3, 1e-3), Between(-0.01, 0.01)};
        } else {
            lens.distortion = {Between(-0.03, 0.03), Between(-0.005, 0.005), Between(-1e-3, 1e-3),
                               Between(-1e-4, 1e-4)};
        }
        lens.max_theta_rad = calib::FieldOf(lens);
        return lens;
    }

    /// A camera somewhere on a vehicle.
    calib::CalibratedCamera Camera(algo::Unit unit, algo::CameraModel::Kind kind) {
        calib::CalibratedCamera camera{.unit = unit, .model = Lens(kind)};
        camera.q_unit_camera =
            calib::RotationFromRpy({Between(-10, 10), Between(-10, 40), Between(-180, 180)});
        camera.position_m = {Between(-6, 6), Between(-2, 2), Between(0, 4)};
        return camera;
    }

    /// Three cameras on the tractor, two on the trailer.
    calib::RigCalibration Rig(algo::CameraModel::Kind kind) {
        calib::RigCalibration rig{.vehicle = "sample", .written_by = "test"};
        for (const char* const name : {"front", "left", "right"})
            rig.cameras[name] = Camera(algo::Unit::kTractor, kind);
        for (const char* const name : {"rear", "rear_left"})
            rig.cameras[name] = Camera(algo::Unit::kTrailer, kind);
        return rig;
    }

    /// A direction that the lens sees.
    Eigen::Vector3d Ray(const algo::CameraModel& lens) {
        const double theta = Between(0, 0.95 * lens.max_theta_rad);
        const double azimuth = Between(-3.14, 3.14);
        return {std::sin(theta) * std::cos(azimuth), std::sin(theta) * std::sin(azimuth),
                std::cos(theta)};
    }

 private:
    std::mt19937 random_;
};

}  // namespace hitchview::tests
