#pragma once

#include <atomic>
#include <filesystem>
#include <string>
#include <vector>

#include "app/scenario_run.hpp"

namespace hitchview::app {

struct ScenariosOptions {
    std::vector<std::string> names;  ///< empty: all
    int camera_width_px = 960;       ///< of the simulated cameras, 16:9
    std::vector<int> lookaheads{0};  ///< each [0, kMaxLookaheadFrames]: each scenario is driven so
    bool offline = false;            ///< and once more in the paper's form
    ScenarioRunOptions run;          ///< lookahead_frames and offline mean nothing here
    std::filesystem::path json;      ///< file for all figures; empty: none
};

/// Drives the scenarios one after another through the pipeline, once per lookahead and once
/// offline, and prints a row of figures for each drive: NAME, NAME+LOOKAHEAD, NAME+all. The file of
/// figures has the same names. Returns the exit code: 0 whatever the figures are, 1 stopped, 2 no
/// such scenario, 3 the machine failed.
int ScenariosVerb(const ScenariosOptions& options, const std::atomic<bool>& stop);

}  // namespace hitchview::app
