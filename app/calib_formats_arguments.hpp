#pragma once

#include <CLI/CLI.hpp>

#include "app/calib_formats_verb.hpp"

namespace hitchview::app {

/// The verbs `import` and `export` of the field tool, with their options.
CLI::App& AddCalibImport(CLI::App& app, CalibImportOptions& options);
CLI::App& AddCalibExport(CLI::App& app, CalibExportOptions& options);

}  // namespace hitchview::app
