#pragma once

#include <cstdint>
#include <optional>
#include <string>

#include "hal/frame.hpp"

namespace hitchview::app {

inline double Milliseconds(hal::Instant time) {
    return static_cast<double>(time.count()) / 1e6;
}

/// "2026-11-22T19:51:39.123456Z"; the number itself where no calendar reaches.
std::string UtcText(std::int64_t utime_us);

/// Microseconds since the epoch: of seconds since `start_us` ("12.5"), or of a UTC time of that
/// form, whose fraction and Z may be left out. Empty for anything else, and before the epoch.
std::optional<std::int64_t> ParseLogTime(const std::string& text, std::int64_t start_us);

}  // namespace hitchview::app
