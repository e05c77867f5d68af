#pragma once

#include <vector>

namespace hitchview::drivers {

/// The value that something has at one moment of the drive.
struct Key {
    double time_s = 0;
    double value = 0;
};

/// A value over time, times ascending: it runs from one key to the next with no step in its rate,
/// which is zero at each key, and rests before the first and after the last.
using Script = std::vector<Key>;

/// `script` has at least one key.
double ValueAt(const Script& script, double time_s);
/// Derivative of ValueAt, per second.
double RateAt(const Script& script, double time_s);

}  // namespace hitchview::drivers
