#include "app/dbc_signal.hpp"

#include <algorithm>
#include <array>
#include <cctype>
#include <cmath>
#include <numbers>
#include <numeric>
#include <string_view>
#include <utility>

namespace hitchview::app {
namespace {

using hal::Checked;

constexpr int kLongestField_bits = 32;
constexpr int kLargestFrame_bits = 64 * 8;
constexpr int kCyclesOfAge = 5;
constexpr std::chrono::milliseconds kLeastAge{100};
constexpr std::chrono::milliseconds kMostAge{60'000};
constexpr double kLargestFactor_deg = 1000;
constexpr double kLargestOffset_deg = 100'000;
constexpr double kLargestAngle_deg = 360;

std::string Named(const DbcSignal& signal) {
    return "(signal " + signal.name + " in line " + std::to_string(signal.line) + ")";
}

// Small letters and digits alone.
std::string Bare(const std::string& text) {
    std::string bare;
    for (const char letter : text) {
        const auto code = static_cast<unsigned char>(letter);
        if (std::isalnum(code) != 0) bare += static_cast<char>(std::tolower(code));
    }
    return bare;
}

template <std::size_t kCount>
bool HasOneOf(const std::string& text, const std::array<const char*, kCount>& parts) {
    return std::ranges::any_of(parts,
                               [&](const char* part) { return text.find(part) != text.npos; });
}

bool IsErrorText(const std::string& bare) {
    return HasOneOf(bare, std::array{"fault", "fail", "error", "invalid"});
}

bool IsNotAvailableText(const std::string& bare) {
    return bare == "sna" || HasOneOf(bare, std::array{"nodata", "notavail", "unavail", "notused",
                                                      "unused", "unknown", "init"});
}

Checked<std::optional<CanMultiplexor>> MultiplexorOf(const DbcMessage& message,
                                                     const DbcSignal& signal) {
    using Maybe = std::optional<CanMultiplexor>;
    const DbcSignal* const multiplexor = message.FindMultiplexor();
    if (signal.extended_multiplexing || (multiplexor != nullptr && multiplexor->multiplexed_by))
        return "a signal without extended multiplexing " + Named(signal);
    if (!signal.multiplexed_by) return Maybe{};
    if (multiplexor == nullptr) return "in a message that has a multiplexor " + Named(signal);
    const auto field = FieldOf(message, *multiplexor);
    if (!field) return field.error();
    return Maybe(CanMultiplexor{field.value(), *signal.multiplexed_by});
}

void TakeRange(const DbcSignal& dbc, double unit_deg, HitchAngleSignal& signal) {
    if (dbc.min >= dbc.max) return;
    signal.min_deg = dbc.min * unit_deg;
    signal.max_deg = dbc.max * unit_deg;
    if (unit_deg < 0) std::swap(signal.min_deg, signal.max_deg);
    for (double* bound_deg : {&signal.min_deg, &signal.max_deg})
        *bound_deg = std::clamp(*bound_deg, -kLargestAngle_deg, kLargestAngle_deg);
}

// Letters to change, insert or leave out; of long names the beginnings count.
std::size_t Distance(std::string_view from, std::string_view to) {
    constexpr std::size_t kLongest = 64;
    from = from.substr(0, kLongest);
    to = to.substr(0, kLongest);
    std::vector<std::size_t> row(to.size() + 1);
    std::iota(row.begin(), row.end(), 0);
    for (std::size_t i = 0; i < from.size(); ++i) {
        std::size_t diagonal = std::exchange(row[0], i + 1);
        for (std::size_t j = 0; j < to.size(); ++j) {
            const std::size_t changed = diagonal + (from[i] == to[j] ? 0 : 1);
            diagonal = row[j + 1];
            row[j + 1] = std::min({changed, row[j] + 1, row[j + 1] + 1});
        }
    }
    return row.back();
}

}  // namespace

Checked<CanField> FieldOf(const DbcMessage& message, const DbcSignal& signal) {
    if (signal.is_float) return "a signal of whole numbers, not floating point " + Named(signal);
    if (signal.length_bits < 1 || signal.length_bits > kLongestField_bits)
        return "a signal of 1 to 32 bits " + Named(signal);
    const int first = signal.motorola ? signal.start_bit ^ 7 : signal.start_bit;
    const int end = first + signal.length_bits;
    if (end > std::min(8 * message.size_bytes, kLargestFrame_bits)) {
        return "a signal that lies inside its message of " + std::to_string(message.size_bytes) +
               " bytes " + Named(signal);
    }
    return CanField{.start_bit = signal.start_bit,
                    .length_bits = signal.length_bits,
                    .byte_order = signal.motorola ? CanByteOrder::kMotorola : CanByteOrder::kIntel,
                    .is_signed = signal.is_signed};
}

std::optional<double> DegreesIn(const std::string& unit) {
    const std::string bare = Bare(unit);
    if (bare == "deg" || bare == "degree" || bare == "degrees") return 1.0;
    if (bare == "rad" || bare == "radian" || bare == "radians") return 180 / std::numbers::pi;
    const bool is_sign = unit == "\xc2\xb0" || unit == "\xb0";  // UTF-8, Latin-1
    return is_sign ? std::optional(1.0) : std::nullopt;
}

HitchAngleCodes CodesOf(const DbcSignal& signal) {
    HitchAngleCodes codes;
    for (const DbcValueText& value : signal.texts) {
        const std::string bare = Bare(value.text);
        if (IsErrorText(bare)) {
            codes.errors.push_back(value.raw);
        } else if (IsNotAvailableText(bare)) {
            codes.not_available.push_back(value.raw);
        }
    }
    return codes;
}

Checked<HitchAngleSignal> HitchAngleOf(const DbcMessage& message, const DbcSignal& dbc,
                                       double unit_deg) {
    const auto field = FieldOf(message, dbc);
    if (!field) return field.error();
    auto multiplexor = MultiplexorOf(message, dbc);
    if (!multiplexor) return multiplexor.error();
    if (dbc.factor == 0) return "a signal whose factor is other than 0 " + Named(dbc);
    if (std::abs(dbc.factor * unit_deg) > kLargestFactor_deg ||
        std::abs(dbc.offset * unit_deg) > kLargestOffset_deg)
        return "a signal with a factor of at most 1000 and an offset of at most 100000 degrees " +
               Named(dbc);
    HitchAngleSignal signal{.id = message.id,
                            .start_bit = field.value().start_bit,
                            .length_bits = field.value().length_bits,
                            .byte_order = field.value().byte_order,
                            .is_signed = field.value().is_signed,
                            .factor_deg = dbc.factor * unit_deg,
                            .offset_deg = dbc.offset * unit_deg,
                            .extended = message.extended,
                            .j1939 = message.extended,
                            .codes = CodesOf(dbc),
                            .multiplexor = multiplexor.value()};
    TakeRange(dbc, unit_deg, signal);
    if (message.cycle_time)
        signal.max_age = std::clamp(kCyclesOfAge * *message.cycle_time, kLeastAge, kMostAge);
    return signal;
}

std::string MostLike(const std::string& name, const std::vector<std::string>& names) {
    constexpr std::size_t kMost = 3;
    std::vector<std::pair<std::size_t, std::string>> by_distance;
    for (const std::string& other : names) by_distance.emplace_back(Distance(name, other), other);
    std::ranges::sort(by_distance);
    std::string text;
    for (std::size_t i = 0; i < std::min(kMost, by_distance.size()); ++i)
        text += ", " + by_distance[i].second;
    return text;
}

}  // namespace hitchview::app
