#pragma once

#include <vector>

#include "drivers/simulated_road.hpp"
#include "drivers/simulated_solids.hpp"

namespace hitchview::drivers {

/// Cars, walls, poles, trees and houses on both sides of the road, from well before its start to
/// well behind `route_m`, each with its shadow. Nothing stands on the road.
std::vector<Solid> PlaceSolids(const Road& road, double route_m, std::uint32_t seed);

}  // namespace hitchview::drivers
