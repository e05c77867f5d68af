#include "drivers/simulated_script.hpp"

#include <algorithm>

#include "hal/expect.hpp"

namespace hitchview::drivers {
namespace {

/// The keys around a moment; the same one twice where the value rests.
struct Between {
    const Key& from;
    const Key& to;
    double share = 0;  // of the way, in time
};

Between KeysAround(const Script& script, double time_s) {
    HV_EXPECT(!script.empty());
    const auto to = std::find_if(script.begin(), script.end(),
                                 [time_s](const Key& key) { return key.time_s > time_s; });
    if (to == script.begin()) return {script.front(), script.front()};
    if (to == script.end()) return {script.back(), script.back()};
    const Key& from = *(to - 1);
    return {from, *to, (time_s - from.time_s) / (to->time_s - from.time_s)};
}

}  // namespace

double ValueAt(const Script& script, double time_s) {
    const auto [from, to, t] = KeysAround(script, time_s);
    return from.value + (to.value - from.value) * t * t * (3 - 2 * t);
}

double RateAt(const Script& script, double time_s) {
    const auto [from, to, t] = KeysAround(script, time_s);
    if (t == 0) return 0;
    return (to.value - from.value) * 6 * t * (1 - t) / (to.time_s - from.time_s);
}

}  // namespace hitchview::drivers
