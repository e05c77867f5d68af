#pragma once

#include <array>
#include <cstdint>

#include "algo/unit.hpp"
#include "algo/unit_geometry.hpp"
#include "hal/camera_state.hpp"
#include "hal/frame_pool.hpp"

namespace hitchview::app {

/// Frames of all cameras taken at one moment. A camera that gave none has an empty lease.
struct FrameSet {
    std::uint32_t sequence = 0;
    algo::PerUnit<std::array<hal::FrameLease, algo::kMaxCameras>> leases;
    hal::Instant captured_from{};       ///< start of the oldest exposure
    hal::Instant captured_until{};      ///< start of the newest exposure
    std::uint32_t cameras_missing = 0;  ///< bit i: camera i of the rig, tractor first
    /// Of the missing: whose device is gone, which has been told; and whose frames came too late.
    std::uint32_t cameras_gone = 0;
    std::uint32_t cameras_late = 0;
    std::uint32_t cameras_disordered = 0;  ///< gave frames with stamps that went back, not taken
    std::array<hal::CameraState, algo::kMaxCameras> camera_states{};  ///< see CameraWatch
    std::uint32_t cameras_repeated = 0;  ///< gave a picture that seems to be the one before

    /// Sets captured_from and captured_until by the frames it has; without any they stay.
    void FindMoments();
};

}  // namespace hitchview::app
