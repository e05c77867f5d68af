#pragma once

#include <vector>

#include "drivers/simulated_lighting.hpp"
#include "drivers/simulated_solids.hpp"

namespace hitchview::drivers {

/// Walls, roof, lamps and the hill above, along x.
void AppendTunnel(const SceneOptions::Tunnel& tunnel, std::vector<Solid>& out);

/// Lit lamps on posts on both sides of the road between `first_m` and `last_m`.
void AppendStreetLamps(const Road& road, double first_m, double last_m, std::vector<Solid>& out);

/// Lays snow on what is flat, and on trees.
void CoverWithSnow(std::vector<Solid>& solids);

}  // namespace hitchview::drivers
