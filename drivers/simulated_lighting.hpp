#pragma once

#include <Eigen/Geometry>

#include "drivers/simulated_options.hpp"
#include "drivers/simulated_road.hpp"

namespace hitchview::drivers {

/// What of the world changes during the drive.
struct Moment {
    double time_s = 0;
    algo::PerUnit<Eigen::Isometry3f> T_unit_world;  ///< as the units ride, for their lamps
};

/// Inside of a tunnel, metres.
struct TunnelProfile {
    static constexpr double kRight = -4.3;  ///< left of the driven lane
    static constexpr double kLeft = 7.8;
    static constexpr double kHeight = 5;
    static constexpr double kLampSpacing = 6;
};

/// Lamps beside the road.
struct StreetLampProfile {
    static constexpr double kSpacing = 24;
    static constexpr double kAcross = -3.9;
    static constexpr double kHeight = 6;
};

/// Light relative to daylight: of the vehicle's own lamps, street lamps, or in a tunnel.
/// Thread-safe.
class Lighting {
 public:
    /// `road` must outlive the lighting.
    Lighting(const SceneOptions& scene, const Road& road);

    /// True if LevelAt is 1 everywhere.
    [[nodiscard]] bool plain_daylight() const { return !night_ && !tunnel_; }
    /// Light of the sky, and share of the sunlight that throws shadows.
    [[nodiscard]] float sky() const { return night_ ? kNightSky : 1.0F; }
    [[nodiscard]] float LevelAt(const Eigen::Vector3d& p_world, const Moment& moment) const;

 private:
    static constexpr float kNightSky = 0.07F;

    [[nodiscard]] float StreetLampsAt(const Eigen::Vector3d& p_world) const;
    [[nodiscard]] float TunnelAt(const Eigen::Vector3d& p_world) const;

    bool night_;
    std::optional<SceneOptions::Tunnel> tunnel_;
    const Road& road_;
};

}  // namespace hitchview::drivers
