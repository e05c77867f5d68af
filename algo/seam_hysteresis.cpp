#include "algo/seam_hysteresis.hpp"

#include <algorithm>

namespace hitchview::algo {

SeamState SeamHysteresis::Update(const Seen& seen) {
    unmatched_ = seen.matched ? 0 : std::min(unmatched_ + 1, kCoast);
    stood_ = std::min(stood_ + 1, kHold);
    const bool still_lost = since_locked_ < kHold && !seen.matched;
    since_locked_ = still_lost ? 0 : std::min(since_locked_ + 1, kHold);
    if (LongUnmatched()) since_locked_ = kHold;
    const SeamState wanted = Wanted(seen);
    if (wanted == state_ || !MayBecome(wanted)) return state_;
    if (state_ == SeamState::kLocked) since_locked_ = 0;
    state_ = wanted;
    stood_ = 0;
    return state_;
}

SeamState SeamHysteresis::Wanted(const Seen& seen) const {
    if (seen.matched) return SeamState::kLocked;
    if (!seen.placed || !seen.shared) return SeamState::kNoOverlap;
    return LongUnmatched() ? SeamState::kReacquire : SeamState::kCoast;
}

bool SeamHysteresis::MayBecome(SeamState wanted) const {
    if (state_ == SeamState::kLocked) return true;
    if (wanted == SeamState::kLocked) return since_locked_ >= kHold;
    return stood_ >= kHold;
}

void SeamHysteresis::Reset() {
    *this = SeamHysteresis();
}

}  // namespace hitchview::algo
