#include "app/frame_set.hpp"

#include <algorithm>

namespace hitchview::app {

void FrameSet::FindMoments() {
    bool first = true;
    for (const auto& unit_leases : leases.of) {
        for (const hal::FrameLease& lease : unit_leases) {
            if (!lease) continue;
            const hal::Instant at = lease.view().header.captured_at;
            captured_from = first ? at : std::min(captured_from, at);
            captured_until = first ? at : std::max(captured_until, at);
            first = false;
        }
    }
}

}  // namespace hitchview::app
