#pragma once

#include <optional>

#include "hal/frame.hpp"

namespace hitchview::app {

/// How old the newest picture is by the time it was captured, where sender and receiver have clocks
/// of their own: the quickest picture on its way tells how far the clocks are apart (and how long
/// the way takes at least, which is not counted). Thread: one.
class PictureAge {
 public:
    /// A pause after which the sender may have begun anew.
    static constexpr hal::Instant kPause = std::chrono::seconds(2);

    /// A picture came at `now` of this clock, captured at `captured` of the sender's.
    void Note(hal::Instant captured, hal::Instant now) {
        const bool anew =
            !apart_ || captured < captured_ || (captured > captured_ && now - noted_at_ > kPause);
        // Clocks drift; the quickest picture is forgotten a little faster than that.
        const hal::Instant known = anew ? now - captured : *apart_ + (now - noted_at_) / kForget;
        apart_ = std::min(known, now - captured);
        captured_ = captured;
        noted_at_ = now;
    }
    /// Empty before the first.
    [[nodiscard]] std::optional<hal::Instant> At(hal::Instant now) const {
        if (!apart_) return std::nullopt;
        return now - captured_ - *apart_;
    }

 private:
    static constexpr int kForget = 5000;  // 200 ppm

    hal::Instant captured_{};
    hal::Instant noted_at_{};
    std::optional<hal::Instant> apart_;
};

}  // namespace hitchview::app
