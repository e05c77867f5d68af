#pragma once

#include "app/check_verb.hpp"
#include "app/export_verb.hpp"

namespace CLI {
class App;
}

namespace hitchview::app {

/// The verbs that read logs, on the command line. Each returns its verb; the options must outlive
/// the parsing.
CLI::App& AddCheck(CLI::App& app, CheckOptions& options);
CLI::App& AddExport(CLI::App& app, ExportOptions& options);

}  // namespace hitchview::app
