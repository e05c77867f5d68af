#include "app/scenario_verb.hpp"

#include <cstdio>
#include <nlohmann/json.hpp>

#include "app/exit_code.hpp"
#include "app/report.hpp"
#include "app/scenario_table.hpp"
#include "drivers/simulated_scenario.hpp"

namespace hitchview::app {
namespace {

constexpr int kStopped = 1;

/// A row takes minutes: it is not held back.
void PrintNow(const std::string& text) {
    std::fputs(text.c_str(), stdout);
    std::fflush(stdout);
}

std::string KnownNames() {
    std::string names;
    for (const drivers::Scenario& scenario : drivers::Scenarios())
        names += ' ' + std::string(scenario.name);
    return names;
}

/// Error: one of the names is of no scenario.
hal::Checked<std::vector<drivers::Scenario>> Chosen(const std::vector<std::string>& names) {
    std::vector<drivers::Scenario> chosen;
    for (const std::string& name : names) {
        const drivers::Scenario* found = drivers::FindScenario(name);
        if (found == nullptr) return "there is no scenario " + name + ", there are:" + KnownNames();
        chosen.push_back(*found);
    }
    const auto all = drivers::Scenarios();
    if (names.empty()) chosen.assign(all.begin(), all.end());
    return chosen;
}

/// Every way in which a scenario is driven.
std::vector<ScenarioRunOptions> Runs(const ScenariosOptions& options) {
    std::vector<ScenarioRunOptions> runs;
    for (const int lookahead : options.lookaheads) {
        runs.push_back(options.run);
        runs.back().lookahead_frames = lookahead;
    }
    if (options.offline) {
        runs.push_back(options.run);
        runs.back().offline = true;
    }
    return runs;
}

drivers::SimulationOptions Simulation(const drivers::Scenario& scenario, int camera_width_px) {
    drivers::SimulationOptions simulation = scenario.options;
    simulation.width_px = camera_width_px;
    simulation.height_px = camera_width_px * 9 / 16;
    simulation.render_threads = 1;
    return simulation;
}

}  // namespace

int ScenariosVerb(const ScenariosOptions& options, const std::atomic<bool>& stop) {
    const auto chosen = Chosen(options.names);
    if (!chosen) return Fail(kWrongUse, chosen.error());
    PrintNow(ScenarioHead());
    nlohmann::json report;
    for (const drivers::Scenario& scenario : chosen.value()) {
        const auto simulation = Simulation(scenario, options.camera_width_px);
        for (const ScenarioRunOptions& run : Runs(options)) {
            const auto figures = RunScenario(std::string(scenario.name), simulation, run, stop);
            if (!figures) return Fail(kMachineFailed, figures.error());
            if (stop) return kStopped;
            const std::string name = DriveName(std::string(scenario.name), run);
            PrintNow(ScenarioRow(name, figures.value()));
            report[name] = figures.value();
        }
    }
    if (options.json.empty()) return 0;
    const std::string refused = WriteJson(report, options.json);
    return refused.empty() ? 0 : Fail(kMachineFailed, refused);
}

}  // namespace hitchview::app
