#pragma once

#include <chrono>

#include "hal/frame_pool.hpp"
#include "hal/pool_level.hpp"
#include "hal/result.hpp"

namespace hitchview::hal {

/// Timestamped frames from one camera. Thread: the one that calls WaitFrame.
class Camera {
 public:
    virtual ~Camera() = default;

    /// Size and layout of every frame; constant.
    [[nodiscard]] const FrameFormat& format() const { return DoFormat(); }

    /// Blocks until a frame is ready, at most `timeout` (> 0).
    /// kTimeout: none came; ordinary. kEndOfStream: the recording is over. kCorrupted: this frame
    /// is damaged, the next may be good. kDisconnected: the device is gone; reopen it.
    Result<FrameLease> WaitFrame(std::chrono::milliseconds timeout) {
        HV_EXPECT(timeout.count() > 0);
        return DoWaitFrame(timeout);
    }

    /// The frames that it can lend. Any thread.
    [[nodiscard]] PoolLevel pool() const { return DoPool(); }

 private:
    [[nodiscard]] virtual const FrameFormat& DoFormat() const = 0;
    virtual Result<FrameLease> DoWaitFrame(std::chrono::milliseconds timeout) = 0;
    [[nodiscard]] virtual PoolLevel DoPool() const { return {}; }
};

}  // namespace hitchview::hal
