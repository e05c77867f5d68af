#pragma once

#include <atomic>
#include <chrono>

#include "hal/clock.hpp"

namespace hitchview::hal {

/// Time that passes only when told to, or when somebody sleeps: a sleep ends at once, at its
/// moment.
class FakeClock final : public Clock {
 public:
    static constexpr Instant kEpochAtZero = std::chrono::seconds(1'700'000'000);

    void Advance(std::chrono::nanoseconds duration) { now_ns_.fetch_add(duration.count()); }

 private:
    [[nodiscard]] Instant DoNow() const override { return Instant(now_ns_.load()); }
    void DoSleepUntil(Instant when) override {
        Instant::rep now = now_ns_.load();
        while (now < when.count() && !now_ns_.compare_exchange_weak(now, when.count())) {
        }
    }
    [[nodiscard]] std::int64_t DoEpochMicroseconds(Instant when) const override {
        return std::chrono::duration_cast<std::chrono::microseconds>(kEpochAtZero + when).count();
    }

    std::atomic<Instant::rep> now_ns_{0};
};

}  // namespace hitchview::hal
