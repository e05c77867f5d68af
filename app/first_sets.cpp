#include "app/first_sets.hpp"

namespace hitchview::app {

hal::Result<hal::Done> ShowFirstSets(FrameSynchronizer& sets, StartPatience patience,
                                     const FirstSetsHook& look, const std::atomic<bool>& stop) {
    for (int shown = 0; shown < kFirstSets && !stop;) {
        const auto set = sets.WaitSet();
        if (!set && set.error() == hal::Error::kEndOfStream && shown > 0) break;
        if (!set) return set.error();
        const std::uint32_t late = set.value().cameras_missing & ~patience.cameras_awaited;
        if (late != 0 && patience.sets-- > 0) continue;
        if (look(set.value())) break;
        patience.sets = 0;
        ++shown;
    }
    return hal::Done{};
}

}  // namespace hitchview::app
