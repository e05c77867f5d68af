#pragma once

#include <array>

#include "algo/trailer_placement.hpp"

namespace hitchview::algo {

/// State of the seam of one overlap from what each matched frame set tells (docs/algorithm.md,
/// section 13, with the diagram). LOCKED is left at once: what is not matched is not said to be. It
/// is entered anew after kHold matched frames in a row, or at once if nothing had matched for
/// kCoast frames. Between the other states there are at least kHold frames. So nothing flickers.
class SeamHysteresis {
 public:
    static constexpr int kCoast = 60;  ///< frames without matches before the overlap is searched
    static constexpr int kHold = 5;    ///< frames

    struct Seen {
        bool matched = false;  ///< enough pairs agree with the placement
        bool placed = false;   ///< the trailer was found
        bool shared = false;   ///< there are enough places that both units see
    };

    SeamState Update(const Seen& seen);
    void Reset();

    [[nodiscard]] SeamState state() const { return state_; }
    /// For kCoast frames or more nothing has matched.
    [[nodiscard]] bool LongUnmatched() const { return unmatched_ >= kCoast; }

 private:
    [[nodiscard]] SeamState Wanted(const Seen& seen) const;
    [[nodiscard]] bool MayBecome(SeamState wanted) const;

    SeamState state_ = SeamState::kNoOverlap;
    int unmatched_ = kCoast;    // frames, counted up to kCoast
    int stood_ = kHold;         // frames in this state, counted up to kHold
    int since_locked_ = kHold;  // matched frames in a row since LOCKED was left, likewise
};

}  // namespace hitchview::algo
