#pragma once

#include <Eigen/Geometry>
#include <cstdint>
#include <vector>

#include "drivers/simulated_world.hpp"

namespace hitchview::drivers {

/// What stands around one eye at one moment: makes many rays from there cheap. Thread-safe.
class Outlook {
 public:
    Outlook(const World& world, const Eigen::Vector3d& eye_world, const Moment& moment);

    /// Distance from the eye to the first thing along `direction` (unit length, world axes); kNoHit
    /// for the sky.
    [[nodiscard]] double DistanceTo(const Eigen::Vector3d& direction) const;
    /// Nothing stands between the eye and the point.
    [[nodiscard]] bool IsFreeTo(const Eigen::Vector3d& p_world_m) const;

 private:
    Surroundings around_;
    std::vector<std::uint32_t> all_;
};

}  // namespace hitchview::drivers
