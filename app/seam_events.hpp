#pragma once

#include <optional>

#include "hal/event.hpp"
#include "hal/publisher.hpp"

namespace hitchview::app {

/// Turns the state of one seam into events: one when it is another than was told last, and at most
/// one in kPause, so that a seam that flickers is no flood. Thread: one.
class SeamEvents {
 public:
    static constexpr hal::Instant kPause = std::chrono::seconds(1);

    /// `subject`: left or right.
    explicit SeamEvents(std::string_view subject) : subject_(subject) {}

    /// After each panorama. The first state is the one that changes count from.
    std::optional<hal::Event> Note(hal::SeamState state, int matches, hal::Instant now);

 private:
    std::string_view subject_;
    std::optional<hal::SeamState> told_;
    std::optional<hal::Instant> told_at_;
};

}  // namespace hitchview::app
