#pragma once

#include "hal/clock.hpp"

namespace hitchview::drivers {

/// CLOCK_MONOTONIC of this machine.
class SteadyClock final : public hal::Clock {
 private:
    [[nodiscard]] hal::Instant DoNow() const override;
    void DoSleepUntil(hal::Instant when) override;
    [[nodiscard]] std::int64_t DoEpochMicroseconds(hal::Instant when) const override;
};

}  // namespace hitchview::drivers
