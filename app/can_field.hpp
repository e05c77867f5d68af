#pragma once

#include <cstdint>
#include <optional>
#include <span>

#include "app/config.hpp"

namespace hitchview::app {

/// The raw value of a field of a CAN frame; empty when the frame ends before the field does.
///
/// Bits are numbered as in DBC files: bit b is bit b % 8 of byte b / 8, bit 7 being the highest of
/// its byte. Intel: `start_bit` is the lowest bit of the field and the next higher one is b + 1.
/// Motorola: `start_bit` is the highest bit; the next lower one is b - 1 or, below bit 0 of a byte,
/// bit 7 of the byte after it. Signed values are two's complement.
std::optional<std::int64_t> RawValue(const CanField& field, std::span<const std::uint8_t> data);

}  // namespace hitchview::app
