#include "app/hitch_angle_decoder.hpp"

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <numbers>
#include <span>

#include "app/can_field.hpp"

namespace hitchview::app {
namespace {

using hal::HitchAngleQuality;
using Bytes = std::span<const std::uint8_t>;

// After SAE J1939-71; empty when `raw` is a number there.
std::optional<HitchAngleQuality> J1939Code(const HitchAngleSignal& signal, std::int64_t raw) {
    if (!signal.j1939 || signal.is_signed || signal.length_bits < 8) return std::nullopt;
    const int code_bits = signal.length_bits % 8 == 0 ? 8 : signal.length_bits;
    const std::int64_t code = raw >> (signal.length_bits - code_bits);
    const std::int64_t all_ones = (std::int64_t{1} << code_bits) - 1;
    if (code == all_ones) return HitchAngleQuality::kNotAvailable;
    if (code == all_ones - 1) return HitchAngleQuality::kError;
    return std::nullopt;
}

bool Has(const std::vector<std::int64_t>& values, std::int64_t raw) {
    return std::ranges::find(values, raw) != values.end();
}

// Empty when `raw` is a number.
std::optional<HitchAngleQuality> CodeOf(const HitchAngleSignal& signal, std::int64_t raw) {
    if (Has(signal.codes.errors, raw)) return HitchAngleQuality::kError;
    if (Has(signal.codes.not_available, raw)) return HitchAngleQuality::kNotAvailable;
    return J1939Code(signal, raw);
}

// What the second signal says; empty when the angle may be used.
std::optional<HitchAngleQuality> StatusOf(const HitchAngleSignal& signal, Bytes data) {
    if (!signal.status) return std::nullopt;
    const auto maybe_raw = RawValue(signal.status->field, data);
    if (!maybe_raw || Has(signal.status->errors, *maybe_raw)) return HitchAngleQuality::kError;
    if (!Has(signal.status->valid, *maybe_raw)) return HitchAngleQuality::kNotAvailable;
    return std::nullopt;
}

// Whether the frame is one that carries the angle.
bool Carries(const HitchAngleSignal& signal, const hal::CanFrame& frame, Bytes data) {
    const bool is_message = frame.kind == hal::CanFrameKind::kData && frame.id == signal.id &&
                            frame.extended == signal.IsExtended();
    if (!is_message || !signal.multiplexor) return is_message;
    const auto maybe_page = RawValue(signal.multiplexor->field, data);
    return !maybe_page || *maybe_page == signal.multiplexor->value;
}

bool IsPlausible(const HitchAngleSignal& signal, double angle_deg) {
    // Rounding must not put the last raw value of the range outside of it.
    const double slack_deg = 1e-6 * std::abs(signal.factor_deg);
    return angle_deg >= signal.min_deg - slack_deg && angle_deg <= signal.max_deg + slack_deg;
}

}  // namespace

std::optional<hal::HitchAngle> DecodeHitchAngle(const HitchAngleSignal& signal,
                                                const hal::CanFrame& frame) {
    const Bytes data = Bytes(frame.data).first(frame.size_bytes);
    if (!Carries(signal, frame, data)) return std::nullopt;

    hal::HitchAngle angle{.quality = HitchAngleQuality::kError, .received_at = frame.received_at};
    const auto maybe_raw = RawValue(signal.field(), data);
    if (!maybe_raw) return angle;
    const double angle_deg =
        signal.factor_deg * static_cast<double>(*maybe_raw) + signal.offset_deg;
    const auto number = IsPlausible(signal, angle_deg) ? HitchAngleQuality::kValid
                                                       : HitchAngleQuality::kImplausible;
    angle.quality = StatusOf(signal, data).value_or(CodeOf(signal, *maybe_raw).value_or(number));
    if (angle.quality == HitchAngleQuality::kValid)
        angle.angle_rad = angle_deg * std::numbers::pi / 180;
    return angle;
}

std::optional<hal::HitchAngle> HitchAngleMonitor::Decode(const hal::CanFrame& frame) {
    auto angle = DecodeHitchAngle(signal_, frame);
    if (!angle) return angle;
    seen_at_ = angle->received_at;
    is_stale_ = false;
    if (angle->quality != HitchAngleQuality::kValid) return angle;
    if (IsTooFast(*angle)) {
        *angle = {.quality = HitchAngleQuality::kImplausible, .received_at = angle->received_at};
    } else {
        last_valid_ = angle;
    }
    return angle;
}

std::optional<hal::HitchAngle> HitchAngleMonitor::Stale(hal::Instant now) {
    if (!seen_at_) seen_at_ = now;
    const hal::Instant stale_at = *seen_at_ + signal_.max_age;
    if (signal_.max_age.count() == 0 || is_stale_ || now <= stale_at) return std::nullopt;
    is_stale_ = true;
    return hal::HitchAngle{.quality = HitchAngleQuality::kStale, .received_at = stale_at};
}

bool HitchAngleMonitor::IsTooFast(const hal::HitchAngle& angle) const {
    if (signal_.max_rate_deg_s == 0 || !last_valid_) return false;
    const std::chrono::duration<double> time = angle.received_at - last_valid_->received_at;
    const double turned_deg =
        std::abs(angle.angle_rad - last_valid_->angle_rad) * 180 / std::numbers::pi;
    // The last digit may jump however short the time is.
    const double resolution_deg = std::abs(signal_.factor_deg);
    return turned_deg > signal_.max_rate_deg_s * time.count() + 1.001 * resolution_deg;
}

}  // namespace hitchview::app
