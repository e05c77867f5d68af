#include "app/can_field.hpp"

namespace hitchview::app {
namespace {

using Bytes = std::span<const std::uint8_t>;

// Bits of a frame in the order of the value: Motorola from the top down, Intel from the bottom up.
// In this numbering a field is one run of bits.
struct Run {
    int first;
    int last;
};

bool IsMotorola(const CanField& field) {
    return field.byte_order == CanByteOrder::kMotorola;
}

Run RunOf(const CanField& field) {
    const int first = IsMotorola(field) ? field.start_bit ^ 7 : field.start_bit;
    return {first, first + field.length_bits - 1};
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

}  // namespace

std::optional<std::int64_t> RawValue(const CanField& field, Bytes data) {
    const Run run = RunOf(field);
    if (run.last >= static_cast<int>(data.size()) * 8) return std::nullopt;
    const std::uint64_t bits = IsMotorola(field) ? MotorolaBits(data, run) : IntelBits(data, run);
    const std::int64_t beyond = std::int64_t{1} << field.length_bits;
    const auto raw = static_cast<std::int64_t>(bits) & (beyond - 1);
    const bool is_negative = field.is_signed && raw >= beyond / 2;
    return is_negative ? raw - beyond : raw;
}

}  // namespace hitchview::app
