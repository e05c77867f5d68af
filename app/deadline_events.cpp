#include "app/deadline_events.hpp"

namespace hitchview::app {
namespace {

using hal::Event;
using hal::EventCode;
using hal::EventText;
using hal::Instant;

std::int64_t Milliseconds(Instant duration) {
    return std::chrono::duration_cast<std::chrono::milliseconds>(duration).count();
}

}  // namespace

std::optional<Event> DeadlineEvents::Note(std::uint64_t misses, Instant now) {
    const bool missed = misses > seen_;
    if (missed) newest_ = now;
    if (missed && !began_) {
        before_ = seen_;
        seen_ = misses;
        began_ = now;
        return Missed(now);
    }
    seen_ = misses;
    if (began_ && now - newest_ >= kCalm) return Kept(now);
    return std::nullopt;
}

Event DeadlineEvents::Missed(Instant now) const {
    return {.code = EventCode::kDeadlineMissed,
            .when = now,
            .subject = {},
            .text = EventText("a panorama took longer than the period of ")
                        .AppendNumber(Milliseconds(period_))
                        .Append(" ms")};
}

Event DeadlineEvents::Kept(Instant now) {
    const Instant lasted = newest_ - *began_;
    began_.reset();
    return {.code = EventCode::kDeadlineKept,
            .when = now,
            .subject = {},
            .text = EventText("in time again: ")
                        .AppendNumber(static_cast<std::int64_t>(seen_ - before_))
                        .Append(" were late within ")
                        .AppendNumber(Milliseconds(lasted))
                        .Append(" ms")};
}

std::optional<Event> DropEvents::Note(std::uint64_t dropped, Instant now) {
    if (dropped <= told_ || (told_at_ && now - *told_at_ < kPause)) return std::nullopt;
    const auto count = static_cast<std::int64_t>(dropped - told_);
    told_ = dropped;
    told_at_ = now;
    return Event{.code = EventCode::kPanoramasDropped,
                 .when = now,
                 .subject = {},
                 .text = EventText().AppendNumber(count).Append(
                     " frame sets were left out: the machine is too slow or busy")};
}

}  // namespace hitchview::app
