#pragma once

#include <array>
#include <filesystem>
#include <memory>
#include <string>
#include <vector>

#include "algo/task_runner.hpp"
#include "app/frame_set.hpp"
#include "drivers/simulated_rig.hpp"

namespace hitchview::app {

/// Frame sets of the simulated rig straight from its renderer, rendered several at a time. Borrows
/// rig and runner.
class ScenarioFrames {
 public:
    /// Sets that are rendered at a time; so many from the first one on may be looked at ahead.
    static constexpr int kBatch = 10;

    /// `held_sets`: those that their taker keeps while it takes more. `cache`: folder where frames
    /// are kept between runs, empty for none.
    ScenarioFrames(const drivers::SimulatedRig& rig, int held_sets, std::filesystem::path cache,
                   algo::TaskRunner& runner);

    /// The set of a frame of the newest batch that was not taken yet, or of the next one.
    const FrameSet& Peek(int frame);
    FrameSet Take(int frame);
    /// The next frame is the first one again, and all can be taken once more.
    void Rewind() { batch_.clear(); }

 private:
    /// All frames of one camera: its pictures of a batch are rendered one after another.
    struct Camera {
        std::unique_ptr<hal::FramePool> pool;
        drivers::Renderer::Workspace workspace;
    };

    void FillBatch(int first);
    void FillCamera(int camera);
    void Fill(int camera, int frame, std::span<std::uint8_t> bytes);
    FrameSet& At(int frame);

    const drivers::SimulatedRig& rig_;
    std::filesystem::path cache_;
    algo::TaskRunner& runner_;
    std::array<Camera, drivers::SimulatedRig::kCameras> cameras_;
    int first_ = 0;
    std::vector<FrameSet> batch_;
};

/// Name of a folder for frames of this rig: equal only for rigs that show the same. Looks at tiny
/// pictures of every camera all along the drive.
std::string CacheKey(const drivers::SimulatedRig& rig);

}  // namespace hitchview::app
