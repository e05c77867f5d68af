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
    std::array<float, kWindow> window = window_ms_;
    const auto end = window.begin() + static_cast<std::ptrdiff_t>(n);
    const auto p50 = window.begin() + static_cast<std::ptrdiff_t>(n / 2);
    const auto p99 = window.begin() + static_cast<std::ptrdiff_t>(n * 99 / 100);
    std::nth_element(window.begin(), p50, end);
    if (p99 != p50) std::nth_element(p50 + 1, p99, end);
    return {.last_ms = last_ms(), .p50_ms = *p50, .p99_ms = *p99, .max_ms = max_ms_};
}

}  // namespace hitchview::app
