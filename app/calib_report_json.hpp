#pragma once

#include <nlohmann/json.hpp>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

/// Reading of JSON that may be anything: what is missing, of another type or not finite is absent.
/// Nothing here throws.
namespace hitchview::app {

/// The value of a key; null where there is none.
const nlohmann::json& Part(const nlohmann::json& map, const std::string& key);

std::optional<double> NumberOf(const nlohmann::json& value);
std::optional<double> NumberIn(const nlohmann::json& map, const std::string& key);

/// Empty where there is no text.
std::string TextIn(const nlohmann::json& map, const std::string& key);

/// Empty unless it is a list of numbers only.
std::vector<double> NumbersOf(const nlohmann::json& value);

/// Those of a list that are texts.
std::vector<std::string> TextsOf(const nlohmann::json& value);

/// One of several things with names.
struct NamedPart {
    std::string name{};
    const nlohmann::json* value = nullptr;  ///< borrowed
};

/// The entries of a map, or of a list whose entries have a `name`.
std::vector<NamedPart> NamedParts(const nlohmann::json& value);

}  // namespace hitchview::app
