#pragma once

#include <filesystem>
#include <nlohmann/json.hpp>
#include <string>

namespace hitchview::app {

/// The checks of `verify` and its pictures, as HTML without its verdict.
std::string VerifyReport(const nlohmann::json& verify, const std::filesystem::path& folder);

/// How many of the checks are good, in one line of text.
std::string VerifySummary(const nlohmann::json& verify);

/// A picture of a file, made small enough for a page and held by it; a line of text if it cannot be
/// read.
std::string ReportPicture(const std::filesystem::path& file, const std::string& title);

}  // namespace hitchview::app
