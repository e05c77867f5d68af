#pragma once

#include <atomic>
#include <filesystem>
#include <nlohmann/json_fwd.hpp>
#include <optional>
#include <string>

#include "drivers/simulated_options.hpp"
#include "hal/result.hpp"

namespace hitchview::app {

struct ScenarioRunOptions {
    std::optional<int> frames;  ///< stop after so many frame sets
    int lookahead_frames = 0;   ///< [0, kMaxLookaheadFrames]; no meaning offline
    bool offline = false;       ///< the paper's form: all frames are seen before one is shown
    bool safety_alone = false;  ///< without the figures of quality, in a third of the time
    int canvas_width_px = 2048;
    int workers = 2;              ///< [1, kMaxWorkers]
    std::filesystem::path out;    ///< folder for pictures; empty: none
    std::filesystem::path cache;  ///< folder for rendered frames; empty: none
};

/// SCENARIO, SCENARIO+LOOKAHEAD or, offline, SCENARIO+all: of a row, and of the pictures' files.
std::string DriveName(const std::string& scenario, const ScenarioRunOptions& options);

/// Drives one scenario through the whole pipeline, frames straight from the simulation (offline
/// they are rendered twice unless there is a cache), and measures every panorama against the truth.
/// What ScenarioMeter tells, and the times of the stages. Error: options out of range, or pictures
/// that cannot be written.
hal::Checked<nlohmann::json> RunScenario(const std::string& name,
                                         const drivers::SimulationOptions& simulation,
                                         const ScenarioRunOptions& options,
                                         const std::atomic<bool>& stop);

}  // namespace hitchview::app
