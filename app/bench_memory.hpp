#pragma once

#include <cstddef>
#include <string>
#include <vector>

#include "app/rig_geometry.hpp"

namespace hitchview::app {

/// What one part of the pipeline takes from the heap when it is made.
struct MemoryPart {
    std::string name;
    std::size_t bytes = 0;
};

/// The parts for a rig of this geometry, as a run makes them. `frame`: of one camera, `held_sets`:
/// frame sets that are in memory at once.
std::vector<MemoryPart> MemoryOf(const RigGeometry& geometry, const hal::FrameFormat& frame,
                                 int held_sets);

}  // namespace hitchview::app
