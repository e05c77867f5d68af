#pragma once

#include <CLI/CLI.hpp>
#include <filesystem>
#include <string>
#include <vector>

namespace hitchview::app {

struct CalibReportOptions {
    std::vector<std::filesystem::path> json{};  ///< written by other verbs
    std::filesystem::path out{};
    std::string command{};
};

/// The verb `report` with its options.
CLI::App& AddCalibReport(CLI::App& app, CalibReportOptions& options);

/// Writes one HTML page from the figures of other verbs. 0: done; 2: a file is no JSON of these
/// verbs; 3: the page cannot be written. Verdicts do not change the exit code.
int CalibReportVerb(const CalibReportOptions& options);

}  // namespace hitchview::app
