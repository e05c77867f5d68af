#include "app/log_sets.hpp"

#include <algorithm>
#include <cmath>
#include <optional>

#include "app/evaluation_statistics.hpp"
#include "app/log_time.hpp"

namespace hitchview::app {
namespace {

using hal::Instant;

/// Times that ought to grow, growing.
std::vector<Instant> Sorted(std::vector<Instant> times) {
    if (!std::ranges::is_sorted(times)) std::ranges::sort(times);
    return times;
}

/// The frame nearest to a moment that only moves on.
class NearestFrame {
 public:
    explicit NearestFrame(const std::vector<Instant>& times) : times_(Sorted(times)) {}

    /// Empty if none is nearer than `reach`.
    std::optional<Instant> Take(Instant moment, Instant reach) {
        while (next_ + 1 < times_.size() && Distance(next_ + 1, moment) <= Distance(next_, moment))
            ++next_;
        if (next_ >= times_.size() || Distance(next_, moment) > reach) return std::nullopt;
        return times_[next_];
    }

 private:
    [[nodiscard]] Instant Distance(std::size_t i, Instant moment) const {
        return std::chrono::abs(times_[i] - moment);
    }

    std::vector<Instant> times_;
    std::size_t next_ = 0;
};

}  // namespace

SetFigures MeasureSets(const std::vector<std::vector<Instant>>& times, double period_ms) {
    if (times.empty()) return {};
    const Instant reach(std::llround(period_ms * 1e6 / 2));
    std::vector<NearestFrame> cameras(times.begin(), times.end());
    const auto fullest = std::ranges::max_element(times, {}, &std::vector<Instant>::size);
    SetFigures figures;
    std::vector<double> spreads_ms;
    for (const Instant moment : Sorted(*fullest)) {
        Instant oldest = moment;
        Instant newest = moment;
        std::size_t frames = 0;
        for (NearestFrame& camera : cameras) {
            const auto frame = camera.Take(moment, reach);
            if (!frame) continue;
            ++frames;
            oldest = std::min(oldest, *frame);
            newest = std::max(newest, *frame);
        }
        ++figures.sets;
        figures.complete += frames == times.size() ? 1 : 0;
        if (frames > 1) spreads_ms.push_back(Milliseconds(newest - oldest));
    }
    figures.p50_ms = Quantile(spreads_ms, 0.5);
    figures.p99_ms = Quantile(spreads_ms, 0.99);
    figures.max_ms = Largest(spreads_ms);
    return figures;
}

}  // namespace hitchview::app
