#include "app/frame_deadlines.hpp"

namespace hitchview::app {
namespace {

/// A source that is so far behind does not catch up.
constexpr hal::Instant kLongestLag = std::chrono::milliseconds(500);

}  // namespace

FrameDeadlines::Turn FrameDeadlines::Judge(std::uint32_t sequence, hal::Instant asked,
                                           hal::Instant now) {
    Turn turn{.due = start_ + period_ * sequence};
    hal::Instant late = now - turn.due;
    const bool source_is_late = now - asked > period_ / 2;
    if (source_is_late && late > kLongestLag) {
        start_ += late;
        turn.due += late;
        turn.slipped = true;
        late = {};
    }
    turn.dropped = late > period_ && !source_is_late;
    turn.hurried = late > period_ / 4 || late_last_;
    if (turn.dropped) ++dropped_;
    return turn;
}

void FrameDeadlines::Add(hal::Instant duration) {
    late_last_ = duration > period_;
    if (late_last_) ++misses_;
}

}  // namespace hitchview::app
