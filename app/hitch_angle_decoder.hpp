#pragma once

#include <optional>

#include "app/config.hpp"
#include "hal/can_bus.hpp"
#include "hal/hitch_angle.hpp"

namespace hitchview::app {

/// Reads the hitch angle out of a CAN frame; empty for a frame of another id (or of the same number
/// in the other id format), for remote and error frames, and while the multiplexor, if there is
/// one, says that something else stands there. angle = factor * raw + offset.
///
/// Quality, the first that applies:
/// - kError: the frame ends before the signal does.
/// - What the status signal says, if there is one.
/// - The signal's own codes.
/// - Codes of unsigned signals of at least 8 bits, after SAE J1939-71, unless `j1939` is false.
///   Whole bytes: top byte 0xff is kNotAvailable, 0xfe is kError. Other lengths: all ones is
///   kNotAvailable, one less is kError. Signed signals (all ones is -1 there) and shorter ones have
///   no such codes.
/// - kImplausible: outside [min_deg, max_deg].
/// - kValid.
///
/// Ford's 12-bit signal (frame 1111, 23|12@0+) gives the two codes the other way round: 4095 is
/// 'faulty', 4094 'no data exists'; its DBC file says so. Neither is ever taken for an angle.
std::optional<hal::HitchAngle> DecodeHitchAngle(const HitchAngleSignal& signal,
                                                const hal::CanFrame& frame);

/// The same over time: also tells angles that turned faster than the signal may, and silence.
/// Thread: one. Takes no memory after construction.
class HitchAngleMonitor {
 public:
    explicit HitchAngleMonitor(const HitchAngleSignal& signal) : signal_(signal) {}

    /// As DecodeHitchAngle. kImplausible also where the angle is further from the last valid one
    /// than max_rate_deg_s lets it turn meanwhile; so it recovers by itself where the sensor was
    /// right.
    std::optional<hal::HitchAngle> Decode(const hal::CanFrame& frame);

    /// kStale, once, when `now` is more than max_age after the last frame with the signal (or the
    /// first call). Moments do not step back.
    std::optional<hal::HitchAngle> Stale(hal::Instant now);

 private:
    [[nodiscard]] bool IsTooFast(const hal::HitchAngle& angle) const;

    const HitchAngleSignal signal_;
    std::optional<hal::HitchAngle> last_valid_;
    std::optional<hal::Instant> seen_at_;
    bool is_stale_ = false;
};

}  // namespace hitchview::app
