#pragma once

#include <filesystem>
#include <nlohmann/json_fwd.hpp>
#include <string>

#include "app/run_loop.hpp"

namespace hitchview::app {

/// report.json of a run. What cannot be known is null: `units` and `seams` need the written videos
/// to be measured (`quality`, from Evaluate; null otherwise).
nlohmann::json MakeReport(const RunSummary& run, const nlohmann::json& quality);

/// Empty on success, otherwise why the file could not be written.
std::string WriteJson(const nlohmann::json& json, const std::filesystem::path& file);

/// The run as a table for a person.
std::string Table(const RunSummary& run);

}  // namespace hitchview::app
