#pragma once

#include <cstdint>
#include <optional>
#include <string>

#include "drivers/lcm_log_messages.hpp"
#include "drivers/lcm_log_picture.hpp"

namespace hitchview::app {

/// When a logged picture was captured. `stamped`: by its property, on the sender's CLOCK_MONOTONIC;
/// empty without it. Otherwise since the epoch: the message's own time, or that of its event where
/// the two do not go together (senders that leave theirs 0).
std::optional<hal::Instant> MomentOf(const drivers::LoggedImage& image, std::int64_t utime_us,
                                     bool stamped);

/// "1280x720 MJPG".
std::string Describe(const drivers::LoggedImage& image);
std::string Describe(const drivers::LcmLogPictureKind& kind);

}  // namespace hitchview::app
