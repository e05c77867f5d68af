#pragma once

#include <CLI/CLI.hpp>
#include <filesystem>
#include <optional>
#include <string>
#include <vector>

namespace hitchview::app {

struct HitchOptions {
    std::filesystem::path session{};  ///< one of these two
    std::vector<std::filesystem::path> log{};
    std::filesystem::path out{};          ///< rig calibration; empty: none
    std::filesystem::path json{};         ///< all figures; empty: none
    std::vector<std::string> straight{};  ///< shots; beside the session's
    std::optional<double> height_m{};     ///< instead of the session's
    bool keeps_failed = false;
    std::string command{};  ///< for the calibration
};

CLI::App& AddHitch(CLI::App& app, HitchOptions& options);

/// Finds the hitch point from pictures of a session, or factor and offset of the vehicle's hitch
/// angle from a log. 0: it may be driven with; 1: not, the reasons are told and no calibration is
/// written unless failed ones are kept; 2: wrong use, a bad session, picture or log; 3: a file
/// could not be written.
int HitchVerb(const HitchOptions& options);

}  // namespace hitchview::app
