#pragma once

#include <optional>

#include "drivers/frame_accounting.hpp"
#include "drivers/libcamera_buffers.hpp"
#include "drivers/libcamera_configuration.hpp"
#include "drivers/libcamera_session.hpp"
#include "drivers/libcamera_stamps.hpp"

namespace hitchview::drivers {

/// What OpenLibcamera opens. Thread: see hal::Camera; libcamera's own calls NoteCompleted and
/// NoteGone.
class LibcameraDriver final : public hal::Camera {
 public:
    static hal::Checked<std::unique_ptr<hal::Camera>> Open(const LibcameraOptions& options);
    ~LibcameraDriver() override;
    LibcameraDriver(const LibcameraDriver&) = delete;
    LibcameraDriver& operator=(const LibcameraDriver&) = delete;

 private:
    struct Failure {
        hal::Error error;
        std::string words;
    };
    using Outcome = hal::Result<hal::Done, Failure>;
    /// An answer of WaitFrame's; empty: there is none yet, wait on.
    using MaybeAnswer = std::optional<hal::Result<hal::FrameLease>>;

    explicit LibcameraDriver(const LibcameraOptions& options);

    Outcome Connect();
    Outcome Acquire();
    Outcome Configure(LibcameraGranted& granted);
    Outcome Settle(const LibcameraGranted& granted);
    Outcome Start();
    void Disconnect();

    MaybeAnswer Step(std::chrono::nanoseconds timeout);
    MaybeAnswer TakeFrame(int slot);
    MaybeAnswer Copy(const std::array<hal::Plane, 3>& planes, const hal::FrameHeader& header);
    hal::Instant StampOf(int slot);
    std::optional<std::array<hal::Plane, 3>> WholePlanes(int slot);
    bool IsSilent();
    void Drain();
    hal::Error Lose(hal::CameraLoss why);

    void NoteCompleted(libcamera::Request* request);
    void NoteGone() { mailbox_.NoteGone(); }

    [[nodiscard]] const hal::FrameFormat& DoFormat() const override { return format_; }
    hal::Result<hal::FrameLease> DoWaitFrame(std::chrono::milliseconds timeout) override;
    hal::Result<hal::Done> DoReopen() override;
    [[nodiscard]] hal::CameraLoss DoLoss() const override { return loss_; }
    [[nodiscard]] hal::CameraCounts DoCounts() const override { return accounting_.counts(); }
    [[nodiscard]] hal::PoolLevel DoPool() const override;

    LibcameraOptions options_;
    hal::Instant period_;
    std::shared_ptr<LibcameraSession> session_;
    std::shared_ptr<libcamera::Camera> camera_;  ///< acquired; null: it is gone
    libcamera::ControlList controls_;
    LibcameraMailbox mailbox_;
    LibcameraBuffers buffers_{mailbox_};
    FrameAccounting accounting_;
    LibcameraStampClock stamp_clock_;
    LibcameraLayout layout_;
    hal::FrameFormat format_;
    std::unique_ptr<hal::FramePool> pool_;  ///< of frames that are copied

    bool running_ = false;
    bool drained_ = false;  ///< of what came before the first call of WaitFrame
    hal::Instant heard_at_{};
    std::string last_refusal_;
    hal::CameraLoss loss_ = hal::CameraLoss::kDisconnected;
};

}  // namespace hitchview::drivers
