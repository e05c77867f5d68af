#pragma once

#include <filesystem>
#include <nlohmann/json_fwd.hpp>
#include <string>

namespace hitchview::app {

/// This moment, as 2026-05-01 07:30 UTC.
std::string DateText();

/// What a file says of who wrote it: command, date, and by what limits it was judged, if it was.
std::string WrittenBy(const std::string& command, const std::string& limits = "");

/// Writes figures with `command` and `date`. Empty on success, otherwise why the file could not be
/// written.
std::string WriteFigures(nlohmann::json figures, const std::string& command,
                         const std::filesystem::path& file);

}  // namespace hitchview::app
