#pragma once

#include <atomic>
#include <cstdint>
#include <optional>
#include <string>
#include <string_view>

#include "app/event_queue.hpp"
#include "app/record_ring.hpp"
#include "drivers/lcm_encoder.hpp"
#include "hal/can_bus.hpp"
#include "hal/clock.hpp"

namespace hitchview::app {

struct RecordIntakeOptions {
    std::size_t memory_bytes = std::size_t{64} << 20;
    /// Nothing is lost: who brings a message waits. False: it is left out, and counted.
    bool lossless = false;
    /// Moments are those of this machine's clock, not of a recording or simulation.
    bool live = true;
    std::string can_bus = "can0";
};

/// Takes what is to be recorded, from any thread, as encoded events into a ring, and adds the
/// channel CLOCK once a second. Nothing is taken before Start. Takes no memory after construction.
class RecordIntake {
 public:
    /// `clock` and `events` must outlive it.
    RecordIntake(const RecordIntakeOptions& options, const hal::Clock& clock, EventQueue& events);

    /// From now on; again when the pace of a recording slips. `origin`: moment of the clock that is
    /// moment 0 of the frames.
    void Start(hal::Instant origin);
    /// Nothing is taken any more.
    void Stop() { started_ = false; }
    /// Time of a frame's moment, since the epoch.
    [[nodiscard]] std::int64_t UtimeOf(hal::Instant at) const;
    [[nodiscard]] hal::Instant origin() const { return hal::Instant(origin_ns_.load()); }

    /// Room for an event of at most `bytes`; empty, and counted as dropped, where there is none.
    std::optional<RecordRing::Place> Reserve(std::int64_t utime_us, std::string_view channel,
                                             std::size_t bytes);
    void Commit(const RecordRing::Place& place, std::size_t bytes) { ring_.Commit(place, bytes); }

    /// A message as it was published.
    void Put(const drivers::LcmMessage& message);
    /// `origin`: moment of the clock that is moment 0 of the bus.
    void Put(const hal::CanFrame& frame, hal::Instant origin);

    /// Counts what could not be recorded, and tells of the first of an episode. `why`: for people.
    void NoteDropped(std::string_view why);
    /// So many are no longer there: thrown away by the recorder itself.
    void NoteDropped(std::uint64_t events) { dropped_ += events; }
    /// The next that is dropped begins an episode.
    void EndEpisode() { in_episode_ = false; }
    [[nodiscard]] std::uint64_t dropped() const { return dropped_; }

    [[nodiscard]] RecordRing& ring() { return ring_; }
    [[nodiscard]] const RecordRing& ring() const { return ring_; }
    /// On the clock of what is recorded, which in recordings and simulations is not this machine's.
    [[nodiscard]] hal::Instant Now() const;
    [[nodiscard]] bool started() const { return started_; }
    [[nodiscard]] bool lossless() const { return options_.lossless; }

 private:
    void PutBytes(std::int64_t utime_us, std::string_view channel,
                  std::span<const std::uint8_t> bytes);
    void PutClock(std::int64_t utime_us);

    RecordIntakeOptions options_;
    const hal::Clock& clock_;
    EventQueue& events_;
    RecordRing ring_;
    std::atomic<bool> started_{false};
    std::atomic<hal::Instant::rep> origin_ns_{0};
    std::atomic<std::int64_t> next_clock_us_{0};
    std::atomic<std::uint64_t> dropped_{0};
    std::atomic<bool> in_episode_{false};
};

}  // namespace hitchview::app
