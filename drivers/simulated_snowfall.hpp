#pragma once

#include <Eigen/Geometry>
#include <cstdint>
#include <span>
#include <vector>

#include "algo/camera_model.hpp"

namespace hitchview::drivers {

/// Flakes that fall between a camera and the scene. They are of the world: cameras side by side see
/// the same flake, and a flake moves on from frame to frame. Nothing but the image knows of them.
/// Thread-safe.
class Snowfall {
 public:
    /// `flakes`: within three metres of any place.
    Snowfall(int flakes, std::uint32_t seed);

    /// A camera while its shutter is open.
    struct Shot {
        const algo::CameraModel& lens;
        Eigen::Isometry3d T_world_camera;      ///< as it opens
        Eigen::Isometry3d T_world_camera_end;  ///< as it closes
        double time_s;
        double open_s;
        double gain;
    };
    /// Draws over an image of tightly packed NV12.
    void DrawOver(const Shot& shot, std::span<std::uint8_t> nv12) const;

 private:
    struct Flake {
        Eigen::Vector3d start_m;  // within the cell
        Eigen::Vector3d velocity_mps;
        double radius_m;
    };

    std::vector<Flake> flakes_;
};

}  // namespace hitchview::drivers
