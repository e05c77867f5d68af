#include "app/seam_events.hpp"

namespace hitchview::app {
namespace {

using hal::EventCode;
using hal::EventText;
using hal::SeamState;

EventCode CodeOf(SeamState state) {
    switch (state) {
        case SeamState::kNoOverlap:
            return EventCode::kSeamNoOverlap;
        case SeamState::kReacquire:
            return EventCode::kSeamReacquire;
        case SeamState::kCoast:
            return EventCode::kSeamCoast;
        case SeamState::kLocked:
            return EventCode::kSeamLocked;
    }
    return EventCode::kSeamNoOverlap;
}

EventText TextOf(SeamState state, int matches) {
    switch (state) {
        case SeamState::kNoOverlap:
            return {"the units see no common scene here"};
        case SeamState::kReacquire:
            return {"searching for the alignment"};
        case SeamState::kCoast:
            return EventText("the last alignment is held: ")
                .AppendNumber(matches)
                .Append(" matches are too few");
        case SeamState::kLocked:
            return EventText("aligned by ").AppendNumber(matches).Append(" matches");
    }
    return {};
}

}  // namespace

std::optional<hal::Event> SeamEvents::Note(SeamState state, int matches, hal::Instant now) {
    if (!told_) told_ = state;
    if (state == *told_) return std::nullopt;
    if (told_at_ && now - *told_at_ < kPause) return std::nullopt;
    told_ = state;
    told_at_ = now;
    return hal::Event{
        .code = CodeOf(state), .when = now, .subject = subject_, .text = TextOf(state, matches)};
}

}  // namespace hitchview::app
