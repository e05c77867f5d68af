#pragma once

#include <cstdint>
#include <span>

#include "hal/publisher.hpp"
#include "hal/result.hpp"

namespace hitchview::drivers {

/// Reads a bot_core.image_t that holds a panorama, trusting nothing in it. The image borrows
/// `message`. The JPEG itself is not looked into.
/// kCorrupted: wrong type; a count or size that is negative or reaches past the end; bytes left
/// over; width or height outside [1, 16384]; not MJPEG; one of the panorama's properties (see
/// lcmtypes/bot_core_image_t.lcm) missing, given twice or not a number.
hal::Result<hal::PanoramaImage> ParseImageMessage(std::span<const std::uint8_t> message);

}  // namespace hitchview::drivers
