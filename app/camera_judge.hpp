#pragma once

#include <array>

#include "app/sign_timer.hpp"
#include "hal/camera_state.hpp"
#include "hal/frame.hpp"

namespace hitchview::app {

/// What one frame set shows of one camera.
struct CameraSigns {
    std::array<bool, hal::kCameraStates.size()> shown{};

    bool& operator[](hal::CameraState state) { return shown[static_cast<std::size_t>(state)]; }
    bool operator[](hal::CameraState state) const { return shown[static_cast<std::size_t>(state)]; }
};

/// The state of one camera, from signs that must last before they count and must be gone for a
/// while before they count no more. Thread: one.
class CameraJudge {
 public:
    /// `period`: of the sets, > 0.
    explicit CameraJudge(hal::Instant period);

    /// After each set. Signs of the picture say nothing where there was none, and signs of its
    /// detail nothing where it was the one before: they stay as they are.
    void Note(const CameraSigns& signs, bool has_picture);
    /// The first in the order of hal::CameraState that holds.
    [[nodiscard]] hal::CameraState state() const;
    void Reset();

 private:
    std::array<SignTimer, hal::kCameraStates.size()> timers_;
};

}  // namespace hitchview::app
