#pragma once

#include <optional>

#include "hal/frame.hpp"

namespace hitchview::drivers {

/// The time stamps that the kernel gave one frame, and the clocks when it was read.
struct SocketCanStamps {
    std::optional<hal::Instant> software{};  ///< CLOCK_REALTIME
    std::optional<hal::Instant> hardware{};  ///< the controller's own clock
    hal::Instant wall_now{};                 ///< CLOCK_REALTIME
    hal::Instant now{};                      ///< CLOCK_MONOTONIC
};

/// Turns the kernel's time stamps into moments of CLOCK_MONOTONIC, frame by frame in the order of
/// the bus. Moments never step back and never lie ahead of `now`, whatever the clocks do.
///
/// Software: now - wall_now is the offset between the clocks, measured with each frame. A wall
/// clock that is set touches only the frames which wait in the socket meanwhile: they were stamped
/// on the other side of the step. So of the moments by this offset and by the one before it, the
/// latest that has already been is taken; it is wrong by no more than the frame waited.
///
/// Hardware: the offset is the least delay seen between the two stamps of a frame, over the last
/// one to two seconds (the software stamp can only be late). A controller's clock that jumps is
/// measured afresh.
///
/// Thread: one. Takes no memory.
class SocketCanTime {
 public:
    /// The two clocks before the first frame.
    SocketCanTime(hal::Instant wall_now, hal::Instant now) : last_(now), offset_(now - wall_now) {}

    hal::Instant ReceivedAt(const SocketCanStamps& stamps);

 private:
    [[nodiscard]] hal::Instant FromSoftware(const SocketCanStamps& stamps) const;
    hal::Instant FromHardware(hal::Instant hardware, hal::Instant received_at);
    void MeasureDelay(hal::Instant offset, hal::Instant received_at);

    /// Least software moment - hardware stamp within a second.
    struct Window {
        hal::Instant since{};
        hal::Instant least_offset = hal::Instant::max();
    };

    hal::Instant last_;    // what was returned last
    hal::Instant offset_;  // now - wall_now at the frame before
    Window this_second_;
    Window second_before_;
};

}  // namespace hitchview::drivers
