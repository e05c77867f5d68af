#pragma once

#include <array>
#include <atomic>
#include <cstddef>
#include <cstdint>
#include <optional>

#include "hal/event.hpp"
#include "hal/event_log.hpp"

namespace hitchview::app {

/// How often each event happened, and how many of them nobody could be told of.
struct EventCounts {
    std::array<std::uint64_t, hal::kEventCodes.size()> happened{};  ///< as in hal::kEventCodes
    std::uint64_t refused = 0;                                      ///< found the queue full
};

/// Events from whoever notices them to the thread that publishes them, in the order in which they
/// came. What does not fit is refused and counted. Takes no memory; nobody waits for anybody: a
/// bounded queue whose places carry the turn at which they may be written or read.
class EventQueue {
 public:
    static constexpr std::size_t kCapacity = 64;

    /// `log`, unless it is null, is told of each event that is put here, and must outlive it.
    explicit EventQueue(hal::EventLog* log = nullptr);
    EventQueue(const EventQueue&) = delete;
    EventQueue& operator=(const EventQueue&) = delete;

    /// False if the queue is full. Any thread.
    bool Put(const hal::Event& event);
    /// Empty when there is nothing. Thread: one.
    std::optional<hal::Event> Take();

    /// What is put here appears where stderr goes. Any thread.
    [[nodiscard]] bool is_on_stderr() const { return log_ != nullptr && log_->has_stderr(); }

    /// Since construction. Any thread.
    [[nodiscard]] EventCounts counts() const;

 private:
    struct Place {
        /// Of the writer that may have it; one more: it is written, and the reader's.
        std::atomic<std::uint64_t> turn{0};
        hal::Event event;
    };
    static_assert((kCapacity & (kCapacity - 1)) == 0, "capacity is a power of two");

    /// The place that the caller alone may write, at `turn`; null when the queue is full.
    Place* Claim(std::uint64_t& turn);
    void Count(hal::EventCode code);

    hal::EventLog* const log_;
    std::array<Place, kCapacity> places_;
    alignas(64) std::atomic<std::uint64_t> end_{0};
    alignas(64) std::uint64_t begin_ = 0;  // the reader's
    std::array<std::atomic<std::uint64_t>, hal::kEventCodes.size()> happened_{};
    std::atomic<std::uint64_t> refused_{0};
};

}  // namespace hitchview::app
