#pragma once

#include <Eigen/Geometry>
#include <cstdint>
#include <span>
#include <vector>

#include "algo/camera_model.hpp"
#include "drivers/simulated_options.hpp"

namespace hitchview::drivers {

/// The sun low over the horizon, and what it does to a camera that looks towards it: the disc and
/// its bloom saturate, stray light veils the rest of the picture, reflections within the lens lie
/// on the line through its middle. Thread-safe.
class LowSun {
 public:
    LowSun(const SceneOptions::Sun& sun, const algo::CameraModel& lens);

    /// Unit length, world frame.
    [[nodiscard]] const Eigen::Vector3d& direction() const { return direction_; }

    /// A camera at one moment.
    struct Shot {
        Eigen::Isometry3d T_world_camera;
        double free = 1;  ///< share of the disc that nothing hides
        double gain = 1;
    };
    /// Draws over an image of tightly packed NV12.
    void DrawOver(const Shot& shot, std::span<std::uint8_t> nv12) const;

 private:
    /// Light that a ray of the camera takes up beside that of the scene, grey levels.
    [[nodiscard]] double GlareAt(const Eigen::Vector3d& ray, const Eigen::Vector3d& sun) const;

    Eigen::Vector3d direction_;
    double strength_;
    algo::CameraModel lens_;
    std::vector<Eigen::Vector3d> rays_camera_;  ///< of each pixel; zero: none
};

}  // namespace hitchview::drivers
