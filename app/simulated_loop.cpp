#include "app/simulated_loop.hpp"

#include <array>

namespace hitchview::app {

std::unique_ptr<drivers::LoopedFrames> RenderLoop(const drivers::SimulatedRig& rig,
                                                  const std::vector<int>& cameras, int frames) {
    std::array<drivers::Renderer::Workspace, drivers::SimulatedRig::kCameras> workspaces;
    const auto draw = [&](int camera, int frame, std::span<std::uint8_t> out) {
        if (!rig.CameraPresent(camera, frame)) return false;
        rig.Render(camera, frame, workspaces[static_cast<std::size_t>(camera)], out);
        return true;
    };
    return std::make_unique<drivers::LoopedFrames>(rig.format(), cameras, frames, draw);
}

}  // namespace hitchview::app
