#include "app/hitch_angle_decoder.hpp"

#include <cmath>
#include <cstdint>
#include <numbers>
#include <span>

namespace hitchview::app {
namespace {

using hal::HitchAngleQuality;
using Bytes = std::span<const std::uint8_t>;

constexpr std::uint32_t kLargestStandardId = 0x7ff;

// Bits of a frame in the order of the value: Motorola from the top down, Intel from the bottom up.
// In this numbering a signal is one run of bits.
struct Run {
    int first;
    int last;
};

Run RunOf(const HitchAngleSignal& signal) {
    const bool motorola = signal.byte_order == HitchAngleSignal::ByteOrder::kMotorola;
    const int first = motorola ? signal.start_bit ^ 7 : signal.start_bit;
    return {first, first + signal.length_bits - 1};
}

std::uint64_t MotorolaBits(Bytes data, Run run) {
    std::uint64_t bits = 0;
    for (int i = run.first / 8; i <= run.last / 8; ++i) bits = bits << 8 | data[i];
    return bits >> (7 - run.last % 8);
}

std::uint64_t IntelBits(Bytes data, Run run) {
    std::uint64_t bits = 0;
    for (int i = run.last / 8; i >= run.first / 8; --i) bits = bits << 8 | data[i];
    return bits >> (run.first % 8);
}

// Empty when the frame is too short.
std::optional<std::uint64_t> RawOf(const HitchAngleSignal& signal, Bytes data) {
    const Run run = RunOf(signal);
    if (run.last >= static_cast<int>(data.size()) * 8) return std::nullopt;
    const bool motorola = signal.byte_order == HitchAngleSignal::ByteOrder::kMotorola;
    const std::uint64_t bits = motorola ? MotorolaBits(data, run) : IntelBits(data, run);
    return bits & ((std::uint64_t{1} << signal.length_bits) - 1);
}

// Empty when `raw` is a number.
std::optional<HitchAngleQuality> CodeOf(const HitchAngleSignal& signal, std::uint64_t raw) {
    if (signal.is_signed || signal.length_bits < 8) return std::nullopt;
    const int code_bits = signal.length_bits % 8 == 0 ? 8 : signal.length_bits;
    const std::uint64_t code = raw >> (signal.length_bits - code_bits);
    const std::uint64_t all_ones = (std::uint64_t{1} << code_bits) - 1;
    if (code == all_ones) return HitchAngleQuality::kNotAvailable;
    if (code == all_ones - 1) return HitchAngleQuality::kError;
    return std::nullopt;
}

double DegreesOf(const HitchAngleSignal& signal, std::uint64_t raw) {
    auto value = static_cast<std::int64_t>(raw);
    const std::int64_t sign = std::int64_t{1} << (signal.length_bits - 1);
    if (signal.is_signed && (value & sign) != 0) value -= 2 * sign;
    return signal.factor_deg * static_cast<double>(value) + signal.offset_deg;
}

bool IsPlausible(const HitchAngleSignal& signal, double angle_deg) {
    // Rounding must not put the last raw value of the range outside of it.
    const double slack_deg = 1e-6 * std::abs(signal.factor_deg);
    return angle_deg >= signal.min_deg - slack_deg && angle_deg <= signal.max_deg + slack_deg;
}

}  // namespace

std::optional<hal::HitchAngle> DecodeHitchAngle(const HitchAngleSignal& signal,
                                                const hal::CanFrame& frame) {
    const bool extended = signal.id > kLargestStandardId;
    if (frame.id != signal.id || frame.extended != extended) return std::nullopt;

    hal::HitchAngle angle{.quality = HitchAngleQuality::kError, .received_at = frame.received_at};
    const auto maybe_raw = RawOf(signal, Bytes(frame.data).first(frame.size_bytes));
    if (!maybe_raw) return angle;
    const double angle_deg = DegreesOf(signal, *maybe_raw);
    const auto number = IsPlausible(signal, angle_deg) ? HitchAngleQuality::kValid
                                                       : HitchAngleQuality::kImplausible;
    angle.quality = CodeOf(signal, *maybe_raw).value_or(number);
    if (angle.quality == HitchAngleQuality::kValid)
        angle.angle_rad = angle_deg * std::numbers::pi / 180;
    return angle;
}

}  // namespace hitchview::app
