#pragma once

#include <filesystem>
#include <nlohmann/json.hpp>
#include <string>

namespace hitchview::app {

/// The places of a unit's cameras, of the figures of `unit`, as HTML without its verdict. `folder`:
/// where the names of pictures begin.
std::string UnitReport(const nlohmann::json& unit, const std::filesystem::path& folder);

/// Its figures that count most, in one line of text.
std::string UnitSummary(const nlohmann::json& unit);

}  // namespace hitchview::app
