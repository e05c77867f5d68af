#pragma once

#include <cstdint>
#include <optional>

#include "hal/frame.hpp"

namespace hitchview::app {

/// Decides which frame sets are worth their time in a run at the cameras' pace: set i is due i
/// periods after the start, and a set that is late by more than a period is dropped, so that
/// latency never queues up. Thread: one.
class FrameDeadlines {
 public:
    FrameDeadlines(hal::Instant start, hal::Instant period) : start_(start), period_(period) {}

    struct Turn {
        bool dropped = false;
        bool hurried = false;  ///< what can be left out of this set's work should be
        hal::Instant due{};    ///< not to be shown earlier
        bool slipped = false;  ///< the start has moved
    };
    /// `asked`: when the set was asked for; `now`: when it came. Nothing newer exists than a set
    /// that was waited for: it is shown though it is late. Sources that are slower than the
    /// cameras' pace for long make the start slip.
    Turn Judge(std::uint32_t sequence, hal::Instant asked, hal::Instant now);
    /// How long a set took that was not dropped.
    void Add(hal::Instant duration);

    [[nodiscard]] hal::Instant start() const { return start_; }
    [[nodiscard]] std::uint64_t dropped() const { return dropped_; }
    [[nodiscard]] std::uint64_t misses() const { return misses_; }

 private:
    hal::Instant start_;
    hal::Instant period_;
    bool late_last_ = false;
    std::uint64_t dropped_ = 0;
    std::uint64_t misses_ = 0;
};

}  // namespace hitchview::app
