#pragma once

#include <cstdint>
#include <memory>
#include <utility>
#include <vector>

#include "drivers/simulated_rig.hpp"

namespace hitchview::tests {

inline std::unique_ptr<drivers::SimulatedRig> Rig(const drivers::SimulationOptions& options) {
    return std::move(drivers::SimulatedRig::Create(options).value());
}

/// NV12, as the camera sees the world in this frame.
inline std::vector<std::uint8_t> Rendered(const drivers::SimulatedRig& rig, int camera, int frame) {
    std::vector<std::uint8_t> image(hal::FrameBytes(rig.format()));
    drivers::Renderer::Workspace workspace;
    rig.Render(camera, frame, workspace, image);
    return image;
}

}  // namespace hitchview::tests
