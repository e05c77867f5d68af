#pragma once

#include <memory>
#include <optional>
#include <span>

#include "drivers/frame_accounting.hpp"
#include "drivers/frame_jpeg_decoder.hpp"
#include "drivers/v4l2_buffers.hpp"
#include "drivers/v4l2_negotiation.hpp"
#include "drivers/v4l2_stamps.hpp"
#include "hal/camera.hpp"

namespace hitchview::drivers {

/// What became of the options, for a person and for the health of the system.
struct V4l2CameraFacts {
    V4l2Identity identity;
    V4l2Granted granted;  ///< when the stream started last
    V4l2StampSource stamps = V4l2StampSource::kEndOfFrame;
    bool dmabuf = false;
    double buffer_read_gb_per_s = 0;    ///< of a mapped buffer
    double ordinary_read_gb_per_s = 0;  ///< of as much of ordinary memory
};

/// Camera over the Linux video capture interface (V4L2), single- or multi-planar.
///
/// Frames are the driver's own buffers, lent without a copy, in what format they come (UYVY, YUYV,
/// NV12 in one or two memory planes, GREY); Motion JPEG is decoded to NV12 in the thread that
/// calls WaitFrame. What came between Open and the first call of WaitFrame is old by then: it is
/// dropped, and not counted. captured_at: see ExposureStart. Sequence: the device's, made to go on
/// without a gap when a stream starts again.
///
/// kCorrupted: the driver has marked the frame, it is too short, cannot be decoded, or its stamp
/// steps back. kDisconnected: the device has gone or failed, its source has changed to another
/// format, or it kept silent and a restart did not help. From then on, until Reopen succeeds, each
/// call answers so at once. A change of source that leaves the format as it was only costs the
/// frames in between, and counts as reopened.
///
/// Reopen finds the device by the path that was opened, whatever number it has now. kUnsupported:
/// another driver or model is there, on a path /dev/videoN also another place (a number may
/// pass to the camera next to it), or it no longer gives the format.
///
/// No memory from the heap after Open. Leases must not outlive the camera. Says on stderr when a
/// camera is lost, why, and when it is back. Thread: see hal::Camera; it alone calls into the
/// kernel, but for the waking of it by a lease that ends.
class V4l2Camera final : public hal::Camera {
 public:
    /// The error names device, what was wanted, what was got and what is offered.
    static hal::Checked<std::unique_ptr<V4l2Camera>> Open(const V4l2CameraOptions& options,
                                                          V4l2Kernel& kernel = SystemKernel());
    /// The same, for who goes on without a camera that may come later.
    using Opened = hal::Result<std::unique_ptr<V4l2Camera>, V4l2Refusal>;
    static Opened TryOpen(const V4l2CameraOptions& options, V4l2Kernel& kernel = SystemKernel());

    /// A camera that cannot be opened yet, for the reason that TryOpen gave, and is lost from the
    /// start: Reopen has it as soon as it is there. Nobody can ask it what it gives; its format is
    /// what V4l2Negotiation::Expect makes of the options and of the `others`, cameras of the same
    /// rig that were opened. kUnsupported from Reopen, with the reason on stderr: it gives another,
    /// or cannot be set up like them.
    static std::unique_ptr<V4l2Camera> Await(const V4l2CameraOptions& options,
                                             const V4l2Failure& why,
                                             std::span<const V4l2Camera* const> others,
                                             V4l2Kernel& kernel = SystemKernel());
    ~V4l2Camera() override;

    [[nodiscard]] const V4l2CameraFacts& facts() const { return facts_; }

    /// The DMABUF that a plane of a lent frame lies in; file -1: none (exported by no means, or
    /// decoded). The file stays the camera's; it is valid as long as the lease. Thread:
    /// WaitFrame's.
    [[nodiscard]] V4l2Buffers::Dmabuf FindDmabuf(const hal::Plane& plane) const {
        return buffers_.FindDmabuf(plane.data);
    }

 private:
    V4l2Camera(const V4l2CameraOptions& options, V4l2Kernel& kernel);

    hal::Result<hal::Done, V4l2Refusal> Start();
    void Settle(const V4l2Granted& granted);
    void NoteFacts();

    V4l2Result<hal::Done> Stream();
    V4l2Result<hal::Done> AgreeAgainAndStream();

    struct Woken {
        bool frame = false;
        bool event = false;
        bool error = false;
    };
    /// An answer of WaitFrame's; empty: there is none yet, wait on.
    using MaybeAnswer = std::optional<hal::Result<hal::FrameLease>>;

    Woken Wait(std::chrono::milliseconds timeout);
    MaybeAnswer Step(std::chrono::milliseconds timeout);
    MaybeAnswer TakeFrame();
    MaybeAnswer FollowSource();
    void Drain();
    MaybeAnswer Lend(const V4l2Buffers::Filled& filled);
    MaybeAnswer Decode(const V4l2Buffers::Filled& filled, const hal::FrameHeader& header);
    V4l2Result<hal::Done> Watch();
    hal::Error Lose(const V4l2Failure& failure);
    void Disconnect();
    hal::Error NoteRefused(const V4l2Failure& failure);

    [[nodiscard]] const hal::FrameFormat& DoFormat() const override { return format_; }
    hal::Result<hal::FrameLease> DoWaitFrame(std::chrono::milliseconds timeout) override;
    hal::Result<hal::Done> DoReopen() override;
    [[nodiscard]] hal::CameraLoss DoLoss() const override { return loss_; }
    [[nodiscard]] hal::CameraCounts DoCounts() const override { return accounting_.counts(); }
    [[nodiscard]] hal::PoolLevel DoPool() const override;

    V4l2CameraOptions options_;
    hal::Instant period_;
    V4l2Negotiation negotiation_;
    V4l2Device& device_;
    V4l2Buffers buffers_;
    FrameAccounting accounting_;
    V4l2CameraFacts facts_;
    hal::FrameFormat format_;
    std::unique_ptr<hal::FramePool> pool_;  ///< of decoded frames
    std::unique_ptr<FrameJpegDecoder> decoder_;

    bool streaming_ = false;
    bool drained_ = false;    ///< of what came before the first call of WaitFrame
    bool restarted_ = false;  ///< since the last frame, for its silence
    hal::Instant heard_at_{};
    V4l2Failure last_refusal_;
    hal::CameraLoss loss_ = hal::CameraLoss::kDisconnected;
};

}  // namespace hitchview::drivers
