#pragma once

#include <memory>
#include <vector>

#include "drivers/looped_frames.hpp"
#include "drivers/simulated_rig.hpp"

namespace hitchview::app {

/// The first `frames` frames of the drive, of `cameras` by their index in the rig. Takes as long as
/// they take to render, on as many threads as cameras.
std::unique_ptr<drivers::LoopedFrames> RenderLoop(const drivers::SimulatedRig& rig,
                                                  const std::vector<int>& cameras, int frames);

}  // namespace hitchview::app
