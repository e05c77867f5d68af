#pragma once

#include <cstdint>
#include <optional>

#include "hal/event.hpp"
#include "hal/frame.hpp"

namespace hitchview::app {

/// Turns the count of panoramas that took longer than a period into episodes: one event when they
/// begin, one when none was late for kCalm. Thread: one.
class DeadlineEvents {
 public:
    static constexpr hal::Instant kCalm = std::chrono::seconds(2);

    explicit DeadlineEvents(hal::Instant period) : period_(period) {}

    /// `misses`: since the start. Often, also when no panorama comes.
    std::optional<hal::Event> Note(std::uint64_t misses, hal::Instant now);

 private:
    hal::Event Missed(hal::Instant now) const;
    hal::Event Kept(hal::Instant now);

    hal::Instant period_;
    std::uint64_t seen_ = 0;
    std::uint64_t before_ = 0;           ///< misses when the episode began
    std::optional<hal::Instant> began_;  ///< while an episode lasts
    hal::Instant newest_{};              ///< miss that was seen last
};

/// Turns the count of frame sets that were never shown into events: one when they begin to be left
/// out, and while that goes on one in kPause with those left out since. Thread: one.
class DropEvents {
 public:
    static constexpr hal::Instant kPause = std::chrono::seconds(10);

    /// `dropped`: since the start.
    std::optional<hal::Event> Note(std::uint64_t dropped, hal::Instant now);

 private:
    std::uint64_t told_ = 0;
    std::optional<hal::Instant> told_at_;
};

}  // namespace hitchview::app
