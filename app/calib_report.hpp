#pragma once

#include <filesystem>
#include <nlohmann/json.hpp>
#include <string>
#include <vector>

namespace hitchview::app {

/// A JSON file that a verb of the field tool has written.
struct ReportSource {
    std::filesystem::path file{};
    std::string sha256{};
    nlohmann::json content{};
};

/// All of them as one HTML document that needs no other file, no network and no script: verdicts
/// and reasons first, then each lens, unit and check with its figures and drawings. What a file
/// does not have is said; keys that are not known are passed over. `written_by`: command and date.
std::string CalibReport(const std::vector<ReportSource>& sources, const std::string& written_by);

}  // namespace hitchview::app
