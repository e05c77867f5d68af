#include "app/scenario_verb.hpp"

#include <cstdio>
#include <nlohmann/json.hpp>

#include "app/report.hpp"
#include "app/scenario_table.hpp"

namespace hitchview::app {
namespace {

constexpr int kStopped = 1;
constexpr int kWrongUse = 2;
constexpr int kMachineFailed = 3;

struct Scenario {
    std::string_view name;
    std::string_view what;
    drivers::SimulationOptions options;
};

std::vector<Scenario> Scenarios() {
    drivers::SimulationOptions straight;
    straight.profile = drivers::DriveProfile::kStraight;
    drivers::SimulationOptions slalom;
    slalom.speed_mps = 4;
    slalom.curvature_per_m = 0.12;
    return {{"straight", "", straight}, {"slalom", "", slalom}};
}

int Fail(int code, const std::string& why) {
    std::fprintf(stderr, "%s\n", why.c_str());
    return code;
}

std::string KnownNames() {
    std::string names;
    for (const Scenario& scenario : Scenarios()) names += ' ' + std::string(scenario.name);
    return names;
}

/// Empty if one of them is unknown: that one is left in `unknown`.
std::vector<Scenario> Chosen(const std::vector<std::string>& names, std::string& unknown) {
    const std::vector<Scenario> all = Scenarios();
    if (names.empty()) return all;
    std::vector<Scenario> chosen;
    for (const std::string& name : names) {
        const auto found =
            std::find_if(all.begin(), all.end(), [&](const Scenario& s) { return s.name == name; });
        if (found == all.end()) {
            unknown = name;
            return {};
        }
        chosen.push_back(*found);
    }
    return chosen;
}

}  // namespace

int ScenariosVerb(const ScenariosOptions& options, const std::atomic<bool>& stop) {
    std::string unknown;
    const std::vector<Scenario> chosen = Chosen(options.names, unknown);
    if (chosen.empty())
        return Fail(kWrongUse, "there is no scenario " + unknown + ", there are:" + KnownNames());
    std::fputs(ScenarioHead().c_str(), stdout);
    nlohmann::json report;
    for (const Scenario& scenario : chosen) {
        drivers::SimulationOptions simulation = scenario.options;
        simulation.width_px = options.camera_width_px;
        simulation.height_px = options.camera_width_px * 9 / 16;
        simulation.render_threads = 1;
        const std::string name(scenario.name);
        const auto figures = RunScenario(name, simulation, options.run, stop);
        if (!figures) return Fail(kMachineFailed, figures.error());
        if (stop) return kStopped;
        std::fputs(ScenarioRow(name, figures.value()).c_str(), stdout);
        std::fflush(stdout);
        report[name] = figures.value();
    }
    if (options.json.empty()) return 0;
    const std::string refused = WriteJson(report, options.json);
    return refused.empty() ? 0 : Fail(kMachineFailed, refused);
}

}  // namespace hitchview::app
