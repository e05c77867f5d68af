#include "app/calib_report_json.hpp"

#include <cmath>

namespace hitchview::app {

using nlohmann::json;

const json& Part(const json& map, const std::string& key) {
    static const json kNone;
    if (!map.is_object()) return kNone;
    const auto found = map.find(key);
    return found == map.end() ? kNone : *found;
}

std::optional<double> NumberOf(const json& value) {
    if (!value.is_number()) return std::nullopt;
    const auto number = value.get<double>();
    return std::isfinite(number) ? std::optional(number) : std::nullopt;
}

std::optional<double> NumberIn(const json& map, const std::string& key) {
    return NumberOf(Part(map, key));
}

std::string TextIn(const json& map, const std::string& key) {
    const json& value = Part(map, key);
    return value.is_string() ? value.get<std::string>() : "";
}

std::vector<double> NumbersOf(const json& value) {
    std::vector<double> numbers;
    if (!value.is_array()) return numbers;
    for (const json& item : value) {
        const auto number = NumberOf(item);
        if (!number) return {};
        numbers.push_back(*number);
    }
    return numbers;
}

std::vector<std::string> TextsOf(const json& value) {
    std::vector<std::string> texts;
    if (!value.is_array()) return texts;
    for (const json& item : value) {
        if (item.is_string()) texts.push_back(item.get<std::string>());
    }
    return texts;
}

std::vector<NamedPart> NamedParts(const json& value) {
    std::vector<NamedPart> parts;
    if (value.is_object()) {
        for (const auto& [name, part] : value.items()) parts.push_back({name, &part});
    } else if (value.is_array()) {
        for (const json& part : value) parts.push_back({TextIn(part, "name"), &part});
    }
    return parts;
}

}  // namespace hitchview::app
