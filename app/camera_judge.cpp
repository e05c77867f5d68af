#include "app/camera_judge.hpp"

#include <cmath>
#include <utility>

namespace hitchview::app {
namespace {

using hal::CameraState;
using std::chrono::milliseconds;

/// How long a sign must be there, and how long gone.
struct Patience {
    milliseconds enter, leave;
};

/// What makes old pictures is believed at once; what may pass by itself, like the white side of a
/// lorry, or a lamp, must last.
constexpr Patience PatienceWith(CameraState state) {
    switch (state) {
        case CameraState::kGood:
        case CameraState::kLost:
            return {milliseconds(200), milliseconds(170)};
        case CameraState::kFrozen:
            return {milliseconds(100), milliseconds(100)};
        case CameraState::kLate:
        case CameraState::kDisordered:
        case CameraState::kStuck:
            return {milliseconds(200), milliseconds(330)};
        case CameraState::kBlack:
            return {milliseconds(330), milliseconds(200)};
        case CameraState::kBlinded:
            return {milliseconds(500), milliseconds(330)};
        case CameraState::kBlurred:
            return {milliseconds(1000), milliseconds(500)};
        case CameraState::kDirty:
            return {milliseconds(2000), milliseconds(500)};
    }
    return {milliseconds(1000), milliseconds(1000)};
}

int SetsIn(hal::Instant time, hal::Instant period) {
    const double sets = static_cast<double>(time.count()) / static_cast<double>(period.count());
    return std::max(1, static_cast<int>(std::lround(sets)));
}

SignTimer TimerOf(CameraState state, hal::Instant period) {
    const Patience patience = PatienceWith(state);
    return {SetsIn(patience.enter, period), SetsIn(patience.leave, period)};
}

template <std::size_t... kIndices>
std::array<SignTimer, sizeof...(kIndices)> Timers(hal::Instant period,
                                                  std::index_sequence<kIndices...> /*indices*/) {
    return {TimerOf(hal::kCameraStates[kIndices], period)...};
}

/// What a picture that is shown again says nothing new of.
constexpr bool IsOfDetail(CameraState state) {
    return state == CameraState::kBlurred || state == CameraState::kDirty;
}

constexpr bool IsOfPicture(CameraState state) {
    return state == CameraState::kBlack || state == CameraState::kBlinded ||
           state == CameraState::kFrozen || state == CameraState::kStuck || IsOfDetail(state);
}

}  // namespace

CameraJudge::CameraJudge(hal::Instant period)
    : timers_(Timers(period, std::make_index_sequence<hal::kCameraStates.size()>())) {}

void CameraJudge::Note(const CameraSigns& signs, bool has_picture) {
    for (const CameraState state : hal::kCameraStates) {
        if (!has_picture && IsOfPicture(state)) continue;
        if (signs[CameraState::kFrozen] && IsOfDetail(state)) continue;
        timers_[static_cast<std::size_t>(state)].Note(signs[state]);
    }
}

CameraState CameraJudge::state() const {
    for (const CameraState state : hal::kCameraStates) {
        if (timers_[static_cast<std::size_t>(state)].holds()) return state;
    }
    return CameraState::kGood;
}

void CameraJudge::Reset() {
    for (SignTimer& timer : timers_) timer.Reset();
}

}  // namespace hitchview::app
