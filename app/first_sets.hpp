#pragma once

#include <atomic>
#include <functional>

#include "app/frame_synchronizer.hpp"

namespace hitchview::app {

/// Frame sets that may be looked at to find the trailer before the first one is shown.
inline constexpr int kFirstSets = 10;

/// Looks at one set; true once it has seen enough.
using FirstSetsHook = std::function<bool(const FrameSet&)>;

/// Live cameras start one after the other, some of them a second late.
struct StartPatience {
    int sets = 0;  ///< that lack a camera and are passed over before the first, at most
    std::uint32_t cameras_awaited = 0;  ///< that nobody waits for: bits of cameras_missing
};

/// Shows `look` the first sets, at most kFirstSets, until it has seen enough or `stop` is set. A
/// recording that is over ends it too, unless it had no set at all. Other errors: those of `sets`.
hal::Result<hal::Done> ShowFirstSets(FrameSynchronizer& sets, StartPatience patience,
                                     const FirstSetsHook& look, const std::atomic<bool>& stop);

}  // namespace hitchview::app
