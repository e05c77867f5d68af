#pragma once

#include "app/bench_verb.hpp"
#include "app/demo_verb.hpp"
#include "app/scenario_verb.hpp"

namespace CLI {
class App;
}

namespace hitchview::app {

/// The verbs of simulated drives, on the command line. Each returns its verb; the options must
/// outlive the parsing.
CLI::App& AddDemo(CLI::App& app, DemoOptions& options);
CLI::App& AddScenarios(CLI::App& app, ScenariosOptions& options);
CLI::App& AddBench(CLI::App& app, BenchOptions& options);

}  // namespace hitchview::app
