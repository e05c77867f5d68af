#pragma once

#include "drivers/simulated_rig.hpp"
#include "hal/camera.hpp"

namespace hitchview::drivers {

/// One camera of the simulated rig. WaitFrame renders the next frame on the calling thread, as fast
/// as it can and without skipping any; it does not pace. kTimeout: every frame of the pool is lent
/// out. kCorrupted: one frame of an outage. kEndOfStream after the last frame of the drive.
class SimulatedCamera final : public hal::Camera {
 public:
    /// `rig` must outlive the camera. Frame i is captured at `start` + i periods.
    SimulatedCamera(const SimulatedRig& rig, int camera_index, hal::Instant start,
                    int pool_frames = 4);

 private:
    [[nodiscard]] const hal::FrameFormat& DoFormat() const override { return pool_.format(); }
    hal::Result<hal::FrameLease> DoWaitFrame(std::chrono::milliseconds timeout) override;
    [[nodiscard]] hal::PoolLevel DoPool() const override { return pool_.level(); }

    const SimulatedRig& rig_;
    int camera_index_;
    hal::Instant start_;
    hal::FramePool pool_;
    Renderer::Workspace workspace_;
    int next_frame_ = 0;
};

}  // namespace hitchview::drivers
