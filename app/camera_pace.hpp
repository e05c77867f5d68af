#pragma once

#include <cstdint>
#include <optional>

#include "hal/frame.hpp"

namespace hitchview::app {

/// How fast a camera's own clock runs, from the moments and numbers of its frames; since it was
/// last away, as nobody numbers the frames of that time. Thread: one.
class CameraPace {
 public:
    void Add(const hal::FrameHeader& frame) {
        if (!Follows(frame)) first_ = frame;
        newest_ = frame;
    }

    /// Mean time from one frame to the next; empty before the second.
    [[nodiscard]] std::optional<double> period_ms() const {
        const auto maybe_ns = period_ns();
        return maybe_ns ? std::optional(1e-6 * *maybe_ns) : std::nullopt;
    }

 private:
    [[nodiscard]] std::optional<double> period_ns() const {
        if (!first_ || newest_.sequence == first_->sequence) return std::nullopt;
        return PerStep(*first_, newest_);
    }

    static double PerStep(const hal::FrameHeader& early, const hal::FrameHeader& late) {
        return static_cast<double>((late.captured_at - early.captured_at).count()) /
               (late.sequence - early.sequence);
    }

    /// Later than the newest one, by as many periods as its number says.
    [[nodiscard]] bool Follows(const hal::FrameHeader& frame) const {
        if (!first_ || frame.captured_at <= newest_.captured_at) return false;
        if (frame.sequence == newest_.sequence) return false;
        const auto maybe_ns = period_ns();
        return !maybe_ns || PerStep(newest_, frame) < 1.5 * *maybe_ns;
    }

    std::optional<hal::FrameHeader> first_;
    hal::FrameHeader newest_{};
};

}  // namespace hitchview::app
