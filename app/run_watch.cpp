#include "app/run_watch.hpp"

namespace hitchview::app {

RunWatch::RunWatch(const RunWatchOptions& options, EventQueue& events)
    : options_(options),
      events_(events),
      health_(options.health),
      seams_{SeamEvents("left"), SeamEvents("right")},
      deadlines_(options.period) {}

void RunWatch::Start(hal::Instant now) {
    if (started_) return;
    health_.Start(now, ReadResources());
    next_health_ = now;
    if (!options_.receive_buffer.warning.view().empty()) {
        Put(hal::Event{.code = hal::EventCode::kReceiveBufferSmall,
                       .when = now,
                       .subject = {},
                       .text = options_.receive_buffer.warning});
    }
    started_.store(true, std::memory_order_release);
}

void RunWatch::Update(hal::Instant now, std::uint64_t unsent) {
    unsent_ = unsent;
    if (!started_.load(std::memory_order_acquire)) return;
    while (const auto figures = figures_.Take()) Note(*figures, now);
    if (!options_.realtime) return;
    Put(deadlines_.Note(newest_.deadline_misses, now));
    Put(drops_.Note(newest_.dropped + unsent, now));
}

void RunWatch::Note(const FrameFigures& figures, hal::Instant now) {
    newest_ = figures;
    health_.Add(figures);
    for (const algo::Overlap overlap : algo::kOverlaps) {
        if (!options_.overlaps[overlap]) continue;
        Put(seams_[overlap].Note(figures.seams[overlap], figures.matches[overlap], now));
    }
}

std::optional<hal::Health> RunWatch::MaybeHealth(hal::Instant now) {
    if (!started_.load(std::memory_order_acquire) || now < next_health_) return std::nullopt;
    // A beat that was missed is not made up for.
    next_health_ += kHealthPeriod;
    if (next_health_ < now) next_health_ = now + kHealthPeriod;
    hal::Health health = health_.Measure(now);
    health.dropped += unsent_;
    health.events_lost = events_.counts().refused;
    health.receive_buffer_bytes = options_.receive_buffer.granted_bytes;
    health.warning = options_.receive_buffer.warning;
    return health;
}

void RunWatch::Put(const std::optional<hal::Event>& maybe_event) {
    if (maybe_event) events_.Put(*maybe_event);
}

}  // namespace hitchview::app
