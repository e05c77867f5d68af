#pragma once

#include <algorithm>
#include <cstddef>

#include "hal/frame.hpp"

namespace hitchview::app {

/// Bytes that may go to all clients together: they share so many a second, and more clients get
/// fewer pictures each. It bounds what serving them costs the machine.
class WebBudget {
 public:
    explicit WebBudget(double bytes_per_s) : bytes_per_s_(bytes_per_s), left_(Burst()) {}

    /// False while it is used up. What is taken beyond the rest is owed.
    bool Take(std::size_t bytes, hal::Instant now) {
        if (!HasSome(now)) return false;
        left_ -= static_cast<double>(bytes);
        return true;
    }

    bool HasSome(hal::Instant now) {
        const double elapsed_s = std::chrono::duration<double>(now - refilled_at_).count();
        left_ = std::min(Burst(), left_ + std::max(0.0, elapsed_s) * bytes_per_s_);
        refilled_at_ = std::max(refilled_at_, now);
        return left_ > 0;
    }

 private:
    /// A tenth of a second's worth.
    [[nodiscard]] double Burst() const { return bytes_per_s_ / 10; }

    double bytes_per_s_;
    double left_;
    hal::Instant refilled_at_{};
};

}  // namespace hitchview::app
