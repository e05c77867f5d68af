#pragma once

#include <memory>
#include <utility>

#include "app/frame_tap.hpp"
#include "hal/camera.hpp"

namespace hitchview::app {

/// A camera whose frames a second reader may see: see FrameTap. It needs FrameTap::kHeld frames
/// more than without.
class TappedCamera final : public hal::Camera {
 public:
    explicit TappedCamera(std::unique_ptr<hal::Camera> camera) : camera_(std::move(camera)) {}

    [[nodiscard]] FrameTap& tap() { return tap_; }

 private:
    [[nodiscard]] const hal::FrameFormat& DoFormat() const override { return camera_->format(); }
    hal::Result<hal::FrameLease> DoWaitFrame(std::chrono::milliseconds timeout) override {
        auto frame = camera_->WaitFrame(timeout);
        if (frame) frame.value() = tap_.Offer(std::move(frame.value()));
        return frame;
    }
    hal::Result<hal::Done> DoReopen() override { return camera_->Reopen(); }
    [[nodiscard]] hal::CameraLoss DoLoss() const override { return camera_->loss(); }
    [[nodiscard]] hal::CameraCounts DoCounts() const override { return camera_->counts(); }
    [[nodiscard]] hal::PoolLevel DoPool() const override { return camera_->pool(); }

    std::unique_ptr<hal::Camera> camera_;
    FrameTap tap_;  // last: its leases are the camera's
};

}  // namespace hitchview::app
