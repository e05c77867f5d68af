#pragma once

#include <array>
#include <memory>
#include <vector>

#include "app/fault_script.hpp"
#include "app/picture_fault.hpp"
#include "hal/camera.hpp"
#include "hal/clock.hpp"

namespace hitchview::app {

/// A camera to which a script happens. Its frames are copies where they are not sound. Takes no
/// memory after construction.
class FaultyCamera final : public hal::Camera {
 public:
    /// When the frames of the script are.
    struct Pace {
        /// Live cameras: frame i is i periods after the first frame came. Null: frame i is the i-th
        /// that the camera gives.
        const hal::Clock* clock = nullptr;
        hal::Instant period{};
    };
    /// `slots`: frames that the reader may hold.
    FaultyCamera(std::unique_ptr<hal::Camera> camera, std::vector<CameraFault> faults,
                 const Pace& pace, int slots);

 private:
    /// Frames that a late camera keeps back.
    static constexpr std::size_t kLateBy = 4;

    [[nodiscard]] const hal::FrameFormat& DoFormat() const override { return camera_->format(); }
    hal::Result<hal::FrameLease> DoWaitFrame(std::chrono::milliseconds timeout) override;
    hal::Result<hal::Done> DoReopen() override;
    [[nodiscard]] hal::CameraLoss DoLoss() const override;
    [[nodiscard]] hal::CameraCounts DoCounts() const override { return camera_->counts(); }
    [[nodiscard]] hal::PoolLevel DoPool() const override { return camera_->pool(); }

    [[nodiscard]] bool is_live() const { return pace_.clock != nullptr; }
    [[nodiscard]] int FrameNow() const;
    [[nodiscard]] const CameraFault* FaultAt(int frame) const;
    [[nodiscard]] bool IsGone(const CameraFault* fault) const;
    hal::Result<hal::FrameLease> Afflict(const CameraFault& fault, hal::FrameLease frame);
    hal::Result<hal::FrameLease> KeepBack(const hal::FrameView& view);
    /// Of a frame, or of the one that froze, with this header.
    hal::Result<hal::FrameLease> Copy(const hal::FrameView& view, const hal::FrameHeader& header);
    void Spoil(FaultKind kind, std::span<std::uint8_t> bytes);

    std::unique_ptr<hal::Camera> camera_;
    const std::vector<CameraFault> faults_;
    const Pace pace_;
    hal::FramePool pool_;
    PictureFault picture_;
    int frames_given_ = 0;  ///< by the camera
    hal::Instant started_{};
    bool is_lost_by_itself_ = false;
    const CameraFault* befallen_ = nullptr;
    hal::FrameHeader first_{};  ///< of the frames that it befell
    int frames_befallen_ = 0;
    std::array<hal::FrameLease, kLateBy> kept_;  ///< last: they are the pool's
};

}  // namespace hitchview::app
