#pragma once

#include <chrono>
#include <cstdint>

#include "hal/frame.hpp"

namespace hitchview::drivers {

/// Before the year 2255: in nanoseconds it has 63 bits, and in a candump log ten digits of seconds.
constexpr bool IsEpoch(std::int64_t utime_us) {
    return utime_us >= 0 && utime_us < 9'000'000'000'000'000;
}

/// No machine has been running for a century; sums and differences of such times cannot overflow.
constexpr bool IsInstant(hal::Instant time) {
    return time >= hal::Instant(0) && time < std::chrono::hours(24 * 365 * 100);
}

}  // namespace hitchview::drivers
