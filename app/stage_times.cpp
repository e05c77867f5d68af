#include "app/stage_times.hpp"

#include <algorithm>

namespace hitchview::app {

void StageTimes::Add(std::chrono::nanoseconds duration) {
    const float ms = std::chrono::duration<float, std::milli>(duration).count();
    window_ms_[count_++ % kWindow] = ms;
    max_ms_ = std::max(max_ms_, ms);
}

StageTimes::Summary StageTimes::Summarise() const {
    if (count_ == 0) return {};
    const std::size_t n = std::min(count_, kWindow);
    std::array<float, kWindow> sorted = window_ms_;
    std::sort(sorted.begin(), sorted.begin() + static_cast<std::ptrdiff_t>(n));
    return {.last_ms = window_ms_[(count_ - 1) % kWindow],
            .p50_ms = sorted[n / 2],
            .p99_ms = sorted[n * 99 / 100],
            .max_ms = max_ms_};
}

}  // namespace hitchview::app
