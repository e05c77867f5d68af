#pragma once

#include "app/run_loop.hpp"

namespace hitchview::app {

struct ReplayOptions {
    std::filesystem::path rig{};
    std::vector<std::filesystem::path> logs{};  ///< recordings to be replayed; `rig` may be empty
    std::string from{};                         ///< see LogRigOptions
    std::string to{};
    std::filesystem::path faults{};             ///< script of RunOptions::faults; empty: none
    RunOptions run{};
    std::optional<std::string> coupling{};  ///< literal or corrected; offline only
    bool metrics = false;                   ///< track the written views again and measure them
};

/// `hitchview replay` and `hitchview run`. Returns the exit code: 0 done, 2 rig or options are
/// wrong, 3 a camera, the disk or the network failed.
int ReplayVerb(const ReplayOptions& options, const std::atomic<bool>& stop);

}  // namespace hitchview::app
