#pragma once

#include <filesystem>
#include <nlohmann/json_fwd.hpp>
#include <string>

namespace hitchview::app {

/// This moment, as 2026-05-01 07:30 UTC.
std::string DateText();

/// What a file says of who wrote it: command and date.
std::string WrittenBy(const std::string& command);

/// Writes figures with `command` and `date`. Empty on success, otherwise why the file could not be
/// written.
std::string WriteFigures(nlohmann::json figures, const std::string& command,
                         const std::filesystem::path& file);

}  // namespace hitchview::app
