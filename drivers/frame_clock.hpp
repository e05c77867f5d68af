#pragma once

#include <ctime>

#include "hal/frame.hpp"

namespace hitchview::drivers {

inline hal::Instant InstantOf(const timespec& time) {
    return std::chrono::seconds(time.tv_sec) + std::chrono::nanoseconds(time.tv_nsec);
}

/// What one of the system's clocks shows now.
inline hal::Instant ReadClock(clockid_t clock) {
    timespec time{};
    clock_gettime(clock, &time);
    return InstantOf(time);
}

/// CLOCK_MONOTONIC, the one that frames are stamped by.
inline hal::Instant Now() {
    return ReadClock(CLOCK_MONOTONIC);
}

}  // namespace hitchview::drivers
