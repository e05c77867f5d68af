#pragma once

#include <chrono>
#include <optional>

#include "hal/frame_pool.hpp"

namespace hitchview::drivers {

/// A free slot, within `timeout`, for drivers that make their frames when they are asked for them.
std::optional<hal::FramePool::Slot> WaitSlot(hal::FramePool& pool,
                                             std::chrono::milliseconds timeout);

}  // namespace hitchview::drivers
