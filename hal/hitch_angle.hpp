#pragma once

#include <cstdint>

#include "hal/frame.hpp"

namespace hitchview::hal {

enum class HitchAngleQuality : std::uint8_t {
    kValid = 0,
    kNotAvailable = 1,  ///< the sender says that it has no value
    kError = 2,         ///< the sender says that its sensor failed
    kImplausible = 3,   ///< decoded, and outside the range or the rate that the signal may have
    kStale = 4,         ///< nothing has come for longer than the signal's age may be
};

/// Yaw of the trailer relative to the tractor as the vehicle's own sensor reports it, positive to
/// the left. Logged and published; nothing computes with it.
struct HitchAngle {
    double angle_rad = 0;  ///< meaningful only with kValid
    HitchAngleQuality quality = HitchAngleQuality::kNotAvailable;
    Instant received_at{};  ///< kStale: when it became so
};

}  // namespace hitchview::hal
