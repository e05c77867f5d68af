#pragma once

#include <algorithm>

namespace hitchview::app {

/// Hysteresis of one sign: it holds after `enter` sets in a row that show it, and no longer after
/// `leave` in a row that do not; sets of both kinds in turn weigh against each other at these rates.
class SignTimer {
 public:
    /// Both > 0.
    constexpr SignTimer(int enter, int leave) : enter_(enter), leave_(leave) {}

    /// After each set.
    constexpr void Note(bool shown) {
        level_ = std::clamp(level_ + (shown ? leave_ : -enter_), 0, enter_ * leave_);
        if (level_ == enter_ * leave_) holds_ = true;
        if (level_ == 0) holds_ = false;
    }
    [[nodiscard]] constexpr bool holds() const { return holds_; }
    constexpr void Reset() {
        level_ = 0;
        holds_ = false;
    }

 private:
    int enter_;
    int leave_;
    int level_ = 0;
    bool holds_ = false;
};

}  // namespace hitchview::app
