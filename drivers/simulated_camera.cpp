#include "drivers/simulated_camera.hpp"

#include "drivers/frame_slot.hpp"

namespace hitchview::drivers {

SimulatedCamera::SimulatedCamera(const SimulatedRig& rig, int camera_index, hal::Instant start,
                                 int pool_frames)
    : rig_(rig), camera_index_(camera_index), start_(start), pool_(rig.format(), pool_frames) {}

hal::Result<hal::FrameLease> SimulatedCamera::DoWaitFrame(std::chrono::milliseconds timeout) {
    if (next_frame_ >= rig_.options().frames) return hal::Error::kEndOfStream;
    if (!rig_.CameraPresent(camera_index_, next_frame_)) {
        ++next_frame_;
        return hal::Error::kCorrupted;
    }
    const auto maybe_slot = WaitSlot(pool_, timeout);
    if (!maybe_slot) return hal::Error::kTimeout;
    const int frame = next_frame_++;
    rig_.Render(camera_index_, frame, workspace_, maybe_slot->bytes);
    return pool_.Lease(*maybe_slot, {.sequence = static_cast<std::uint32_t>(frame),
                                     .captured_at = start_ + FrameTime(rig_.options(), frame)});
}

}  // namespace hitchview::drivers
