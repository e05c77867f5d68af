#include "drivers/libcamera_stamps.hpp"

#include <algorithm>
#include <ctime>

namespace hitchview::drivers {
namespace {

hal::Instant Read(clockid_t clock) {
    timespec time{};
    clock_gettime(clock, &time);
    return std::chrono::seconds(time.tv_sec) + std::chrono::nanoseconds(time.tv_nsec);
}

}  // namespace

BootClocks BootClocks::Now() {
    return {Read(CLOCK_MONOTONIC), Read(CLOCK_BOOTTIME)};
}

hal::Instant LibcameraStampClock::ToMonotonic(hal::Instant stamp, const BootClocks& now) {
    boottime_ = boottime_ || (stamp > now.monotonic && stamp <= now.boottime);
    const hal::Instant monotonic = boottime_ ? stamp - (now.boottime - now.monotonic) : stamp;
    return std::min(monotonic, now.monotonic);
}

}  // namespace hitchview::drivers
