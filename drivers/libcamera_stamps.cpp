#include "drivers/libcamera_stamps.hpp"

#include <algorithm>

#include "drivers/frame_clock.hpp"

namespace hitchview::drivers {
BootClocks BootClocks::Now() {
    return {ReadClock(CLOCK_MONOTONIC), ReadClock(CLOCK_BOOTTIME)};
}

hal::Instant LibcameraStampClock::ToMonotonic(hal::Instant stamp, const BootClocks& now) {
    boottime_ = boottime_ || (stamp > now.monotonic && stamp <= now.boottime);
    const hal::Instant monotonic = boottime_ ? stamp - (now.boottime - now.monotonic) : stamp;
    return std::min(monotonic, now.monotonic);
}

}  // namespace hitchview::drivers
