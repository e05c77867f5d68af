#pragma once

#include <string_view>

namespace hitchview::calib {

/// Whether a calibration may be driven with; the tool that measured it says so.
enum class Verdict { kPass, kFail, kUnchecked };

std::string_view ToString(Verdict verdict);

}  // namespace hitchview::calib
