#pragma once

#include <span>
#include <vector>

#include "drivers/simulated_road.hpp"
#include "drivers/simulated_solids.hpp"

namespace hitchview::drivers {

/// Where things may stand.
struct Stage {
    double route_m;  ///< length of the drive along the road
    const SceneOptions& scene;
    std::span<const Eigen::Vector2d> driven;  ///< places that the vehicle comes to off the road
};

/// Cars, walls, poles, trees and houses on both sides of the road, from well before its start to
/// well behind `route_m`, each with its shadow; tunnel and street lamps where the scene has them.
/// Nothing stands on the road, within five metres of a driven place, or in the tunnel's hill.
std::vector<Solid> PlaceSolids(const Road& road, const Stage& stage, std::uint32_t seed);

}  // namespace hitchview::drivers
