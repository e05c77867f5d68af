#pragma once

#include <cmath>

#include "hal/frame.hpp"

namespace hitchview::app {

/// How long a span of a recording takes that is played at `speed` times its own, > 0. Exact at 1.
inline hal::Instant AtSpeed(hal::Instant span, double speed) {
    if (speed == 1) return span;
    return hal::Instant(std::llround(static_cast<double>(span.count()) / speed));
}

}  // namespace hitchview::app
