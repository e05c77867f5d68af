#pragma once

#include <cstdint>
#include <span>

#include "hal/frame.hpp"

namespace hitchview::app {

/// Copies a frame without gaps between its rows and planes to `to`, which has FrameBytes of its
/// format or more. Returns what was written.
std::span<std::uint8_t> PackFrame(const hal::FrameView& frame, std::span<std::uint8_t> to);

}  // namespace hitchview::app
