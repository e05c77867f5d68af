#include "drivers/libcamera_controls.hpp"

#include <libcamera/control_ids.h>

#include <algorithm>
#include <array>
#include <cctype>
#include <charconv>
#include <cmath>
#include <optional>
#include <string_view>

namespace hitchview::drivers {
namespace {

using hal::Checked;
using hal::Done;
using libcamera::ControlInfo;
using libcamera::ControlInfoMap;
using libcamera::ControlList;
using libcamera::ControlType;
using libcamera::ControlValue;
using libcamera::Span;

using Numbers = std::vector<double>;

bool SameName(std::string_view a, std::string_view b) {
    return std::ranges::equal(
        a, b, [](unsigned char x, unsigned char y) { return std::tolower(x) == std::tolower(y); });
}

/// How many numbers a control takes; 0: one that is no array. What libcamera reads as an array and
/// is given otherwise stops the process. Its early releases do not tell which those are.
template <typename Id>
std::size_t ArraySize(const Id& id) {
    if constexpr (requires { id.isArray(); }) {
        return id.isArray() ? id.size() : 0;
    } else {
        constexpr std::array kPairs{"FrameDurationLimits", "ColourGains"};
        if (std::ranges::find(kPairs, id.name()) != kPairs.end()) return 2;
        if (id.name() == "SensorBlackLevels") return 4;
        return id.name() == "ColourCorrectionMatrix" ? 9 : 0;
    }
}

/// "1.5, 2" -> 1.5 2; true is 1, false 0. Empty if it is none of these.
std::optional<Numbers> ReadNumbers(const std::string& text) {
    if (text == "true" || text == "false") return Numbers{text == "true" ? 1.0 : 0.0};
    Numbers numbers;
    const char* at = text.data();
    const char* const end = at + text.size();
    while (at != end) {
        if (*at == ' ' || *at == ',') {
            ++at;
            continue;
        }
        double number = 0;
        const auto [stop, error] = std::from_chars(at, end, number);
        if (error != std::errc{} || !std::isfinite(number)) return std::nullopt;
        numbers.push_back(number);
        at = stop;
    }
    return numbers;
}

/// First element of an array; empty for what is no number.
std::optional<double> NumberOf(const ControlValue& value) {
    const auto first = [&](auto type) {
        return static_cast<double>(*reinterpret_cast<const decltype(type)*>(value.data().data()));
    };
    if (value.numElements() == 0) return std::nullopt;
    switch (value.type()) {
        case libcamera::ControlTypeBool:
            return first(bool{});
        case libcamera::ControlTypeByte:
            return first(std::uint8_t{});
        case libcamera::ControlTypeInteger32:
            return first(std::int32_t{});
        case libcamera::ControlTypeInteger64:
            return first(std::int64_t{});
        case libcamera::ControlTypeFloat:
            return first(float{});
        default:
            return std::nullopt;
    }
}

template <typename T>
ControlValue ValueOf(const Numbers& numbers, bool is_array) {
    if (!is_array) return ControlValue(static_cast<T>(numbers[0]));
    std::vector<T> values;
    for (const double number : numbers) values.push_back(static_cast<T>(number));
    return ControlValue(Span<const T>(values.data(), values.size()));
}

std::optional<ControlValue> ValueOf(ControlType type, const Numbers& numbers, bool is_array) {
    switch (type) {
        case libcamera::ControlTypeBool:
            return ControlValue(numbers[0] != 0);
        case libcamera::ControlTypeByte:
            return ValueOf<std::uint8_t>(numbers, is_array);
        case libcamera::ControlTypeInteger32:
            return ValueOf<std::int32_t>(numbers, is_array);
        case libcamera::ControlTypeInteger64:
            return ValueOf<std::int64_t>(numbers, is_array);
        case libcamera::ControlTypeFloat:
            return ValueOf<float>(numbers, is_array);
        default:
            return std::nullopt;
    }
}

/// Limits of the type itself, so that no number is out of it.
bool FitsType(ControlType type, double number) {
    constexpr double kMostExact = 9007199254740992.0;  // 2^53
    switch (type) {
        case libcamera::ControlTypeBool:
            return number == 0 || number == 1;
        case libcamera::ControlTypeByte:
            return number == std::floor(number) && number >= 0 && number <= 255;
        case libcamera::ControlTypeInteger32:
            return number == std::floor(number) && std::abs(number) <= 2147483647.0;
        case libcamera::ControlTypeInteger64:
            return number == std::floor(number) && std::abs(number) <= kMostExact;
        default:
            return std::abs(number) <= 3.4e38;
    }
}

bool IsAllowed(ControlType type, const ControlInfo& info, double number) {
    if (!FitsType(type, number)) return false;
    if (!info.values().empty()) {
        return std::ranges::any_of(info.values(),
                                   [&](const ControlValue& v) { return NumberOf(v) == number; });
    }
    // A camera that tells no range, or one of nothing, leaves it open.
    const auto minimum = NumberOf(info.min());
    const auto maximum = NumberOf(info.max());
    if (!minimum || !maximum || *minimum >= *maximum) return true;
    constexpr double kRounding = 1e-6;  // of a float beside the text it is written as
    const double slack = type == libcamera::ControlTypeFloat ? kRounding : 0;
    return number >= *minimum - slack && number <= *maximum + slack;
}

std::string AllowedText(const ControlInfo& info) {
    if (info.values().empty()) return info.toString();
    std::string text;
    for (const ControlValue& value : info.values())
        text += (text.empty() ? "one of " : ", ") + value.toString();
    return text;
}

std::string NamesText(const ControlInfoMap& controls) {
    std::vector<std::string> names;
    for (const auto& [id, info] : controls) names.push_back(id->name());
    std::ranges::sort(names);
    std::string text;
    for (const std::string& name : names) text += (text.empty() ? "" : ", ") + name;
    return text.empty() ? "it has none" : "it has " + text;
}

Checked<Done> Plan(const ControlInfoMap& controls, const LibcameraControlWish& wish,
                   ControlList& planned) {
    const auto found = std::ranges::find_if(controls, [&](const ControlInfoMap::value_type& entry) {
        return SameName(entry.first->name(), wish.control);
    });
    if (found == controls.end())
        return "control " + wish.control + " is not one of this camera: " + NamesText(controls);
    const auto& [id, info] = *found;
    const std::size_t array = ArraySize(*id);
    const std::size_t count = std::max<std::size_t>(array, 1);
    const std::string is = "control " + id->name() + " is " + wish.value + ", must be ";
    const auto numbers = ReadNumbers(wish.value);
    const bool any_count = array == libcamera::dynamic_extent;
    if (!numbers || numbers->empty() || (numbers->size() != count && !any_count))
        return is + (any_count    ? "numbers"
                     : count == 1 ? "a number"
                                  : std::to_string(count) + " numbers");
    const bool allowed = std::ranges::all_of(*numbers, [&key = id, &range = info](double n) {
        return IsAllowed(key->type(), range, n);
    });
    if (!allowed) return is + AllowedText(info);
    const auto value = ValueOf(id->type(), *numbers, array > 0);
    if (!value) return "control " + id->name() + " is of a kind that cannot be set from here";
    planned.set(id->id(), *value);
    return Done{};
}

}  // namespace

Checked<ControlList> PlanLibcameraControls(const ControlInfoMap& controls,
                                           const std::vector<LibcameraControlWish>& wishes) {
    ControlList planned(controls);
    for (const LibcameraControlWish& wish : wishes) {
        if (const auto added = Plan(controls, wish, planned); !added) return added.error();
    }
    return planned;
}

Checked<Done> PlanLibcameraRate(const ControlInfoMap& controls, double rate_hz,
                                ControlList& planned) {
    const auto& limits = libcamera::controls::FrameDurationLimits;
    if (controls.count(&limits) == 0 || planned.contains(limits.id())) return Done{};
    const std::string period_us = std::to_string(std::llround(1e6 / rate_hz));
    return Plan(controls, {limits.name(), period_us + " " + period_us}, planned);
}

}  // namespace hitchview::drivers
