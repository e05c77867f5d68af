#pragma once

#include <atomic>
#include <memory>
#include <string>
#include <thread>

#include "hal/blocking_ring.hpp"
#include "hal/camera.hpp"

namespace hitchview::app {

/// A camera that makes its frames on the thread that asks for them, asked ahead on a thread of its
/// own (`src-<name>`). No frame is lost: the thread waits for the reader.
class CameraAhead final : public hal::Camera {
 public:
    /// `camera` has frames for the reader and kAhead + 1 more.
    CameraAhead(std::unique_ptr<hal::Camera> camera, const std::string& name);
    ~CameraAhead() override;

    static constexpr std::size_t kAhead = 2;  ///< frames that wait for the reader

 private:
    /// What the camera answered: a frame, or why there is none.
    struct Outcome {
        hal::FrameLease frame{};
        hal::Error error = hal::Error::kTimeout;
    };

    void Work();
    [[nodiscard]] const hal::FrameFormat& DoFormat() const override { return camera_->format(); }
    hal::Result<hal::FrameLease> DoWaitFrame(std::chrono::milliseconds timeout) override;
    [[nodiscard]] hal::PoolLevel DoPool() const override { return camera_->pool(); }

    std::unique_ptr<hal::Camera> camera_;
    hal::BlockingRing<Outcome, kAhead> outcomes_;
    std::atomic<bool> stop_{false};
    std::thread thread_;
};

}  // namespace hitchview::app
