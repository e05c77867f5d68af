#include "drivers/steady_clock.hpp"

#include <cerrno>
#include <ctime>

#include "drivers/frame_clock.hpp"

namespace hitchview::drivers {

hal::Instant SteadyClock::DoNow() const {
    return ReadClock(CLOCK_MONOTONIC);
}

void SteadyClock::DoSleepUntil(hal::Instant when) {
    const auto whole = std::chrono::duration_cast<std::chrono::seconds>(when);
    const timespec time{.tv_sec = whole.count(), .tv_nsec = (when - whole).count()};
    // An absolute moment: a signal in between does not make the sleep longer.
    while (clock_nanosleep(CLOCK_MONOTONIC, TIMER_ABSTIME, &time, nullptr) == EINTR) {
    }
}

std::int64_t SteadyClock::DoEpochMicroseconds(hal::Instant when) const {
    // The offset is read each time: the wall clock may be set while we run.
    const hal::Instant offset = ReadClock(CLOCK_REALTIME) - ReadClock(CLOCK_MONOTONIC);
    return std::chrono::duration_cast<std::chrono::microseconds>(when + offset).count();
}

}  // namespace hitchview::drivers
