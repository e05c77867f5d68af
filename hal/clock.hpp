#pragma once

#include <cstdint>

#include "hal/frame.hpp"

namespace hitchview::hal {

/// Time and waiting, so that tests own both. Thread-safe.
class Clock {
 public:
    virtual ~Clock() = default;

    /// CLOCK_MONOTONIC.
    [[nodiscard]] Instant Now() const { return DoNow(); }
    /// Returns at once when `when` has passed.
    void SleepUntil(Instant when) { DoSleepUntil(when); }
    /// Microseconds since the epoch of a monotonic moment, for LCM's `utime`.
    [[nodiscard]] std::int64_t EpochMicroseconds(Instant when) const {
        return DoEpochMicroseconds(when);
    }

 private:
    [[nodiscard]] virtual Instant DoNow() const = 0;
    virtual void DoSleepUntil(Instant when) = 0;
    [[nodiscard]] virtual std::int64_t DoEpochMicroseconds(Instant when) const = 0;
};

}  // namespace hitchview::hal
