#pragma once

#include "hal/frame.hpp"

namespace hitchview::drivers {

/// The two clocks that a camera's stamps may be of, read together.
struct BootClocks {
    hal::Instant monotonic{};  ///< stands still while the machine sleeps
    hal::Instant boottime{};   ///< goes on

    static BootClocks Now();
};

/// Brings stamps to CLOCK_MONOTONIC. libcamera documents CLOCK_BOOTTIME, and several of its
/// pipelines hand on the kernel's stamp, which is of CLOCK_MONOTONIC. Both are the same until the
/// machine sleeps; after that a stamp ahead of CLOCK_MONOTONIC can only be of CLOCK_BOOTTIME, and
/// so is each one after it. A machine that has slept for less than a frame's way through it is not
/// told apart: the stamps are off by so much. A stamp ahead of both clocks is of neither: the moment
/// at which its frame was read stands for it.
class LibcameraStampClock {
 public:
    /// `now`: read after the frame had come.
    hal::Instant ToMonotonic(hal::Instant stamp, const BootClocks& now);

 private:
    bool boottime_ = false;
};

}  // namespace hitchview::drivers
