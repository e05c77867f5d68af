#pragma once

#include <array>
#include <optional>

#include "drivers/frame_accounting.hpp"
#include "drivers/looped_frames.hpp"
#include "hal/camera.hpp"
#include "hal/clock.hpp"
#include "hal/ring.hpp"

namespace hitchview::drivers {

struct LoopedCameraOptions {
    int camera = 0;              ///< one of those that were drawn
    hal::Instant period{};       ///< > 0
    hal::Instant start{};        ///< moment of the first frame; of the others, periods later
    std::uint32_t frames = 300;  ///< after so many it ends; LoopedCamera only
    int slots = 4;               ///< frames that it can lend. [1, 64]
};

// Both copy a frame before they lend it, as a device writes into its buffers: whoever reads a frame
// that was given back sees another one, and a thread sanitizer sees him.

/// Shows looped frames as fast as it is read, none of them skipped. kTimeout: all are lent out.
/// kCorrupted: a frame that the camera does not give. kEndOfStream after the last.
class LoopedCamera final : public hal::Camera {
 public:
    /// `frames` must outlive the camera.
    LoopedCamera(const LoopedFrames& frames, const LoopedCameraOptions& options);

 private:
    [[nodiscard]] const hal::FrameFormat& DoFormat() const override { return pool_.format(); }
    hal::Result<hal::FrameLease> DoWaitFrame(std::chrono::milliseconds timeout) override;
    [[nodiscard]] hal::PoolLevel DoPool() const override { return pool_.level(); }

    const LoopedFrames& frames_;
    const LoopedCameraOptions options_;
    hal::FramePool pool_;
    std::uint32_t next_frame_ = 0;
};

/// Shows looped frames as a device that runs at its own pace does, without an end: each is there
/// from its moment of the clock on, and waits, the oldest first, until it is read. One that finds
/// every slot lent or waiting is lost, and is a gap in the sequence. Takes no memory after
/// construction.
class LoopedLiveCamera final : public hal::Camera {
 public:
    /// Both must outlive the camera. `options.start` is a moment of `clock`.
    LoopedLiveCamera(const LoopedFrames& frames, const LoopedCameraOptions& options,
                     hal::Clock& clock);

 private:
    /// A frame that nobody has read yet.
    struct Waiting {
        hal::FramePool::Slot slot{};
        std::uint64_t number = 0;
        bool given = true;  ///< false: what came is damaged
    };

    [[nodiscard]] const hal::FrameFormat& DoFormat() const override { return pool_.format(); }
    hal::Result<hal::FrameLease> DoWaitFrame(std::chrono::milliseconds timeout) override;
    /// At once. What was waiting, and what came since, nobody has seen.
    hal::Result<hal::Done> DoReopen() override;
    [[nodiscard]] hal::CameraCounts DoCounts() const override { return accounting_.counts(); }
    [[nodiscard]] hal::PoolLevel DoPool() const override { return pool_.level(); }

    [[nodiscard]] hal::Instant MomentOf(std::uint64_t number) const;
    void TakeIn(hal::Instant now);
    hal::Result<hal::FrameLease> Lend(const Waiting& frame);

    const LoopedFrames& frames_;
    const LoopedCameraOptions options_;
    hal::Clock& clock_;
    hal::FramePool pool_;
    hal::Ring<Waiting, 64> waiting_;
    std::uint64_t next_frame_ = 0;  ///< the first that has not come yet
    FrameAccounting accounting_;
};

}  // namespace hitchview::drivers
