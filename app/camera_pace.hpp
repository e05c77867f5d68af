#pragma once

#include <cstdint>
#include <optional>

#include "hal/frame.hpp"

namespace hitchview::app {

/// How fast a camera's own clock runs, from the moments and numbers of its frames. Thread: one.
class CameraPace {
 public:
    void Add(const hal::FrameHeader& frame) {
        if (!first_ || frame.captured_at <= newest_.captured_at) first_ = frame;
        newest_ = frame;
    }

    /// The camera has gone: nobody numbers the frames until it is back.
    void Restart() { first_.reset(); }

    /// Mean time from one frame to the next, since the last Restart; empty before the second.
    [[nodiscard]] std::optional<double> period_ms() const {
        if (!first_) return std::nullopt;
        const std::uint32_t steps = newest_.sequence - first_->sequence;
        if (steps == 0) return std::nullopt;
        return 1e-6 * static_cast<double>((newest_.captured_at - first_->captured_at).count()) /
               steps;
    }

 private:
    std::optional<hal::FrameHeader> first_;
    hal::FrameHeader newest_{};
};

}  // namespace hitchview::app
