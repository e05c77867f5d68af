#pragma once

#include <array>
#include <cstdint>

#include "algo/unit.hpp"
#include "app/stage_times.hpp"
#include "algo/unit_geometry.hpp"
#include "hal/camera_state.hpp"
#include "hal/frame.hpp"
#include "hal/publisher.hpp"

namespace hitchview::app {

/// What is known when a panorama has been shown: counts are since the start.
struct FrameFigures {
    std::uint64_t panoramas = 0;
    std::uint64_t dropped = 0;  ///< frame sets never shown
    std::uint64_t deadline_misses = 0;
    std::uint32_t cameras_missing = 0;
    std::array<hal::CameraState, algo::kMaxCameras> camera_states{};
    hal::Instant captured_until{};
    algo::PerOverlap<hal::SeamState> seams{};
    algo::PerOverlap<int> matches{};
    std::array<float, kStages> stage_ms{};
};

}  // namespace hitchview::app
