#pragma once

#include <chrono>
#include <cstdint>

#include "hal/frame.hpp"

namespace hitchview::drivers {

/// Before the year 2286: what a candump log has digits for.
constexpr bool IsEpoch(std::int64_t utime_us) {
    return utime_us >= 0 && utime_us < 10'000'000'000'000'000;
}

/// No machine has been running for a century; sums and differences of such times cannot overflow.
constexpr bool IsInstant(hal::Instant time) {
    return time >= hal::Instant(0) && time < std::chrono::hours(24 * 365 * 100);
}

}  // namespace hitchview::drivers
