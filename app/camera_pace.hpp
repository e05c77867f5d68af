#pragma once

#include <cstdint>
#include <optional>

#include "hal/frame.hpp"

namespace hitchview::app {

/// How fast a camera's own clock runs, from the moments and numbers of its frames. Numbers go on
/// without a gap when a camera comes back, moments do not: the time that it was away is left out.
/// Thread: one.
class CameraPace {
 public:
    /// Frames are further apart than their numbers say by so many periods: the camera was away, or
    /// frames are missing that it did not number. Stamps tremble by less.
    static constexpr int kAwayPeriods = 1;

    /// `period`: what it was asked for, > 0.
    void Add(const hal::FrameHeader& frame, hal::Instant period) {
        if (maybe_newest_) AddStep(*maybe_newest_, frame, period);
        maybe_newest_ = frame;
    }

    /// Mean time from one frame to the next; empty before the second.
    [[nodiscard]] std::optional<double> period_ms() const {
        if (steps_ == 0) return std::nullopt;
        return 1e-6 * static_cast<double>(time_.count()) / static_cast<double>(steps_);
    }

 private:
    void AddStep(const hal::FrameHeader& early, const hal::FrameHeader& late, hal::Instant period) {
        const std::uint32_t steps = late.sequence - early.sequence;
        const hal::Instant time = late.captured_at - early.captured_at;
        if (time.count() <= 0 || time > (std::int64_t{steps} + kAwayPeriods) * period) return;
        time_ += time;
        steps_ += steps;
    }

    std::optional<hal::FrameHeader> maybe_newest_;
    hal::Instant time_{};
    std::uint64_t steps_ = 0;
};

}  // namespace hitchview::app
