#pragma once

#include <chrono>
#include <cstdint>

#include "hal/frame_pool.hpp"
#include "hal/pool_level.hpp"
#include "hal/result.hpp"

namespace hitchview::hal {

/// What became of a camera's frames since it was opened first.
struct CameraCounts {
    std::uint64_t delivered = 0;
    std::uint64_t lost = 0;       ///< gaps of the device's sequence numbers
    std::uint64_t corrupted = 0;  ///< came, and were damaged
    /// Frames that the time stamps lack and the sequence numbers do not (steps of more than 1.5
    /// periods).
    std::uint64_t lost_unnumbered = 0;
    std::uint64_t reopened = 0;  ///< how often the device came back
};

/// Why a camera was lost.
enum class CameraLoss : std::uint8_t {
    kDisconnected,  ///< the device or its driver is gone
    kSilent,        ///< it is there, and gives nothing
    kNoSignal,      ///< nothing is plugged into it, or nothing that it can make out
    kOtherFormat,   ///< what it gives now is not what it was opened for
    kIoError,       ///< it refused to go on
    kBusy,          ///< another program has it
    kForbidden,     ///< this program may not open it
};

constexpr const char* ToString(CameraLoss loss) {
    switch (loss) {
        case CameraLoss::kDisconnected:
            return "disconnected";
        case CameraLoss::kSilent:
            return "silent";
        case CameraLoss::kNoSignal:
            return "no signal";
        case CameraLoss::kOtherFormat:
            return "another format";
        case CameraLoss::kIoError:
            return "I/O error";
        case CameraLoss::kBusy:
            return "in use by another program";
        case CameraLoss::kForbidden:
            return "not permitted";
    }
    return "unknown";
}

/// Timestamped frames from one camera. Thread: the one that calls WaitFrame and Reopen.
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

    /// After kDisconnected, or if it was not there at the start: tries once to have the device, in
    /// the same format, without taking memory from the heap. Frames that are lent stay valid.
    /// kNotFound: it is not there; kUnsupported: it came back as another device, or this camera
    /// cannot be reopened; kFailed: see the log. Try again later.
    Result<Done> Reopen() { return DoReopen(); }

    /// After kDisconnected: why. Thread: WaitFrame's.
    [[nodiscard]] CameraLoss loss() const { return DoLoss(); }

    /// Any thread.
    [[nodiscard]] CameraCounts counts() const { return DoCounts(); }

    /// The frames that it can lend. Any thread.
    [[nodiscard]] PoolLevel pool() const { return DoPool(); }

 private:
    [[nodiscard]] virtual const FrameFormat& DoFormat() const = 0;
    virtual Result<FrameLease> DoWaitFrame(std::chrono::milliseconds timeout) = 0;
    virtual Result<Done> DoReopen() { return Error::kUnsupported; }
    [[nodiscard]] virtual CameraLoss DoLoss() const { return CameraLoss::kDisconnected; }
    [[nodiscard]] virtual CameraCounts DoCounts() const { return {}; }
    [[nodiscard]] virtual PoolLevel DoPool() const { return {}; }
};

}  // namespace hitchview::hal
