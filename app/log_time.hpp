#pragma once

#include <cstdint>
#include <string>

#include "hal/frame.hpp"

namespace hitchview::app {

inline double Milliseconds(hal::Instant time) {
    return static_cast<double>(time.count()) / 1e6;
}

/// "2026-11-22T19:51:39.123456Z"; the number itself where no calendar reaches.
std::string UtcText(std::int64_t utime_us);

}  // namespace hitchview::app
