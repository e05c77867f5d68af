#pragma once

#include <array>
#include <cstdint>

#include "algo/unit.hpp"
#include "algo/unit_geometry.hpp"
#include "hal/frame_pool.hpp"

namespace hitchview::app {

/// Frames of all cameras taken at one moment. A camera that gave none has an empty lease.
struct FrameSet {
    std::uint32_t sequence = 0;
    algo::PerUnit<std::array<hal::FrameLease, algo::kMaxCameras>> leases;
    hal::Instant captured_from{};       ///< start of the oldest exposure
    hal::Instant captured_until{};      ///< start of the newest exposure
    std::uint32_t cameras_missing = 0;  ///< bit i: camera i of the rig, tractor first
};

}  // namespace hitchview::app
