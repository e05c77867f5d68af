#pragma once

#include <CLI/CLI.hpp>
#include <filesystem>

#include "app/calib_sheet_plan.hpp"

namespace hitchview::app {

struct TargetOptions {
    SheetRequest sheet{};
    std::filesystem::path out{};        ///< .pdf or .svg
    std::filesystem::path board_out{};  ///< board file; empty: none
};

CLI::App& AddTarget(CLI::App& app, TargetOptions& options);

/// Writes a sheet to print, and the board file that describes it. 0: written; 2: wrong use, or it
/// does not fit on the paper; 3: a file could not be written.
int TargetVerb(const TargetOptions& options);

}  // namespace hitchview::app
