#include "app/first_sets.hpp"

namespace hitchview::app {

hal::Result<hal::Done> ShowFirstSets(FrameSynchronizer& sets, int patience,
                                     const FirstSetsHook& look, const std::atomic<bool>& stop) {
    for (int shown = 0; shown < kFirstSets && !stop;) {
        const auto set = sets.WaitSet();
        if (!set && set.error() == hal::Error::kEndOfStream && shown > 0) break;
        if (!set) return set.error();
        if (set.value().cameras_missing != 0 && patience-- > 0) continue;
        if (look(set.value())) break;
        patience = 0;
        ++shown;
    }
    return hal::Done{};
}

}  // namespace hitchview::app
