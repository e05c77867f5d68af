#include "app/event_queue.hpp"

#include <algorithm>

namespace hitchview::app {

EventQueue::EventQueue(hal::EventLog* log) : log_(log) {
    for (std::size_t i = 0; i < kCapacity; ++i) places_[i].turn.store(i);
}

bool EventQueue::Put(const hal::Event& event) {
    Count(event.code);
    if (log_ != nullptr) log_->Add(event);
    std::uint64_t turn = 0;
    Place* const place = Claim(turn);
    if (place == nullptr) {
        refused_.fetch_add(1, std::memory_order_relaxed);
        return false;
    }
    place->event = event;
    place->turn.store(turn + 1, std::memory_order_release);
    return true;
}

EventQueue::Place* EventQueue::Claim(std::uint64_t& turn) {
    turn = end_.load(std::memory_order_relaxed);
    while (true) {
        Place& place = places_[turn % kCapacity];
        const std::uint64_t ready_for = place.turn.load(std::memory_order_acquire);
        if (ready_for < turn) return nullptr;  // not read since it was written last
        if (ready_for > turn) {
            turn = end_.load(std::memory_order_relaxed);
        } else if (end_.compare_exchange_weak(turn, turn + 1, std::memory_order_relaxed)) {
            return &place;
        }
    }
}

std::optional<hal::Event> EventQueue::Take() {
    Place& place = places_[begin_ % kCapacity];
    if (place.turn.load(std::memory_order_acquire) != begin_ + 1) return std::nullopt;
    const hal::Event event = place.event;
    place.turn.store(begin_ + kCapacity, std::memory_order_release);
    ++begin_;
    return event;
}

void EventQueue::Count(hal::EventCode code) {
    const auto index = std::ranges::find(hal::kEventCodes, code) - hal::kEventCodes.begin();
    happened_.at(static_cast<std::size_t>(index)).fetch_add(1, std::memory_order_relaxed);
}

EventCounts EventQueue::counts() const {
    EventCounts counts;
    std::ranges::transform(happened_, counts.happened.begin(),
                           [](const auto& count) { return count.load(); });
    counts.refused = refused_.load();
    return counts;
}

}  // namespace hitchview::app
