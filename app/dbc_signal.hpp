#pragma once

#include <string>

#include "app/config.hpp"
#include "app/dbc_file.hpp"
#include "hal/result.hpp"

/// From what a DBC file says to what the decoder needs. Errors say what must be instead.
namespace hitchview::app {

/// Its layout: 1 to 32 bits, inside the message, whole numbers.
hal::Checked<CanField> FieldOf(const DbcMessage& message, const DbcSignal& signal);

/// Degrees in one unit of a physical value; empty where the text of the unit tells nothing.
std::optional<double> DegreesIn(const std::string& unit);

/// Codes among the texts of the signal's values. Texts with fault, fail, error or invalid are
/// errors; those that say no data, not available, not used, unknown or init are not available, and
/// so is SNA. Upper and lower case, spaces and underscores make no difference. Other texts are
/// names of angles.
HitchAngleCodes CodesOf(const DbcSignal& signal);

/// Layout, factor, offset, codes, multiplexor, range (as far as it lies within 360 degrees to each
/// side) and age (five cycles, at least 100 ms, at most a minute) of the angle, all within what
/// HitchAngleSignal allows. `unit_deg`: degrees in one unit of its physical values. A range that
/// the file does not tell and a cycle that it does not tell stay the defaults.
hal::Checked<HitchAngleSignal> HitchAngleOf(const DbcMessage& message, const DbcSignal& signal,
                                            double unit_deg);

/// Up to three of `names`, the most like `name` first, each with a comma before it.
std::string MostLike(const std::string& name, const std::vector<std::string>& names);

}  // namespace hitchview::app
