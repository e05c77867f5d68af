#pragma once

#include <algorithm>
#include <chrono>
#include <optional>

#include "hal/frame.hpp"

namespace hitchview::app {

/// Moments of a recording on a time that begins at 0 with its first frame and only grows, give or
/// take how events are out of order. Where the recording's clock jumps by more than kLongestStep (a
/// pause, a restart of the machine), a period is put in its place. Thread: one.
class LogTimeline {
 public:
    static constexpr hal::Instant kLongestStep = std::chrono::seconds(10);

    /// `period` of the cameras.
    explicit LogTimeline(hal::Instant period) : period_(period) {}

    /// Of a frame. Empty where it is far from the others' moments: the first after a jump, or one
    /// whose moment is damaged.
    std::optional<hal::Instant> Add(hal::Instant logged) {
        if (!shift_) shift_ = -logged;
        if (!IsNear(logged)) {
            const bool jumped = doubt_ && std::chrono::abs(logged - *doubt_) < kLongestStep;
            doubt_ = logged;
            if (!jumped) return std::nullopt;
            shift_ = newest_ + period_ - logged;
        }
        doubt_.reset();
        newest_ = std::max(newest_, logged + *shift_);
        return logged + *shift_;
    }

    /// Whether a frame has been added.
    [[nodiscard]] bool started() const { return shift_.has_value(); }

    /// Of something else. Empty where it is far from the frames' moments.
    [[nodiscard]] std::optional<hal::Instant> MomentOf(hal::Instant logged) const {
        if (!shift_ || !IsNear(logged)) return std::nullopt;
        return logged + *shift_;
    }

 private:
    [[nodiscard]] bool IsNear(hal::Instant logged) const {
        return std::chrono::abs(logged + *shift_ - newest_) < kLongestStep;
    }

    hal::Instant period_;
    std::optional<hal::Instant> shift_;  ///< from the recording's time to this one
    hal::Instant newest_{};              ///< on this one
    std::optional<hal::Instant> doubt_;  ///< a moment far from the others, until the next frame
};

}  // namespace hitchview::app
