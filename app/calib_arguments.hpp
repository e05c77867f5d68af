#pragma once

#include <CLI/CLI.hpp>

#include "app/calib_intrinsics_verb.hpp"
#include "app/calib_report_verb.hpp"

namespace hitchview::app {

// What the verbs of hitchview-calib are called with.

CLI::App& AddIntrinsics(CLI::App& app, IntrinsicsOptions& options);
CLI::App& AddReport(CLI::App& app, CalibReportOptions& options);

}  // namespace hitchview::app
