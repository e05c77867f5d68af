#pragma once

#include <atomic>

#include "app/replay_verb.hpp"

namespace CLI {
class App;
}

namespace hitchview::app {

/// The verbs that make panoramas, on the command line. Each returns its verb; the options must
/// outlive the parsing. `trigger`: of the recorder, see RecorderOptions.
CLI::App& AddRun(CLI::App& app, ReplayOptions& options, std::atomic<bool>& trigger);
CLI::App& AddReplay(CLI::App& app, ReplayOptions& options);

}  // namespace hitchview::app
