#pragma once

#include <optional>

#include "hal/frame.hpp"

namespace hitchview::app {

/// How old the newest picture is by the time it was captured, where sender and receiver have clocks
/// of their own: the quickest picture on its way tells how far the clocks are apart (and how long
/// the way takes at least, which is not counted). Thread: one.
class PictureAge {
 public:
    /// A pause after which the sender may have begun anew, or may send what it had held back.
    static constexpr hal::Instant kPause = std::chrono::seconds(2);
    /// What has been held back is all there after this long: if every picture still seems old, then
    /// the sender has begun anew.
    static constexpr hal::Instant kDoubt = std::chrono::seconds(1);

    /// A picture came at `now` of this clock, captured at `captured` of the sender's.
    void Note(hal::Instant captured, hal::Instant now) {
        const hal::Instant way = now - captured;
        if (!apart_ || captured < captured_) {
            apart_ = way;
            doubt_.reset();
        } else {
            if (now - noted_at_ > kPause) doubt_ = {now, way};
            // Clocks drift; the quickest picture is forgotten a little faster than that.
            apart_ = std::min(*apart_ + (now - noted_at_) / kForget, way);
            if (captured > captured_) Settle(way, now);
        }
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

    struct Doubt {
        hal::Instant since;
        hal::Instant quickest;
    };

    void Settle(hal::Instant way, hal::Instant now) {
        if (!doubt_) return;
        doubt_->quickest = std::min(doubt_->quickest, way);
        if (now - doubt_->since < kDoubt) return;
        apart_ = doubt_->quickest;
        doubt_.reset();
    }

    hal::Instant captured_{};
    hal::Instant noted_at_{};
    std::optional<hal::Instant> apart_;
    std::optional<Doubt> doubt_;
};

}  // namespace hitchview::app
