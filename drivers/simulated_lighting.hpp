#pragma once

#include <Eigen/Geometry>
#include <array>

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

/// Lamps on one side of the road: where the row starts, left of the driven lane.
struct StreetLampRow {
    double along_m, across_m;
};
inline constexpr double kStreetLampSpacing_m = 24;
inline constexpr double kStreetLampHeight_m = 6;
inline constexpr std::array kStreetLampRows{StreetLampRow{0, -3.9}, StreetLampRow{12, 7.4}};

/// Light relative to daylight: of the vehicle's own lamps, street lamps, or in a tunnel.
/// Thread-safe.
class Lighting {
 public:
    /// `road` must outlive the lighting.
    Lighting(const SceneOptions& scene, const Road& road);

    /// True if LevelAt is 1 everywhere.
    [[nodiscard]] bool plain_daylight() const { return !night_ && !tunnel_; }
    /// Light of the sky.
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
