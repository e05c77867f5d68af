#pragma once

#include <optional>

#include "app/config.hpp"
#include "hal/can_bus.hpp"
#include "hal/hitch_angle.hpp"

namespace hitchview::app {

/// Reads the hitch angle out of a CAN frame; empty for a frame of another id (or of the same number
/// in the other id format: above 0x7ff is extended).
///
/// Bits are numbered as in DBC files: bit b is bit b % 8 of byte b / 8, bit 7 being the highest of
/// its byte. Intel: `start_bit` is the lowest bit of the signal and the next higher one is b + 1.
/// Motorola: `start_bit` is the highest bit; the next lower one is b - 1 or, below bit 0 of a byte,
/// bit 7 of the byte after it. Signed values are two's complement. angle = factor * raw + offset.
///
/// Quality, the first that applies:
/// - kError: the frame ends before the signal does.
/// - Codes of unsigned signals of at least 8 bits, after SAE J1939-71. Whole bytes: top byte 0xff
/// is
///   kNotAvailable, 0xfe is kError. Other lengths: all ones is kNotAvailable, one less is kError.
///   Signed signals (all ones is -1 there) and shorter ones have no codes.
/// - kImplausible: outside [min_deg, max_deg].
/// - kValid.
///
/// Ford's 12-bit signal (frame 1111, 23|12@0+) gives the two codes the other way round: 4095 is
/// 'faulty', 4094 'no data exists'. Neither is ever taken for an angle.
std::optional<hal::HitchAngle> DecodeHitchAngle(const HitchAngleSignal& signal,
                                                const hal::CanFrame& frame);

}  // namespace hitchview::app
