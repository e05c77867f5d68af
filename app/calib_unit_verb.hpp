#pragma once

#include <CLI/CLI.hpp>
#include <filesystem>
#include <string>

namespace hitchview::app {

struct UnitOptions {
    std::filesystem::path session{};
    std::filesystem::path out{};   ///< rig calibration; empty: none
    std::filesystem::path into{};  ///< rig calibration whose other unit is kept; empty: none
    std::filesystem::path json{};  ///< all figures; empty: none
    std::filesystem::path view{};  ///< picture to look at; empty: none
    std::filesystem::path maps{};  ///< folder; empty: none
    std::string far{};             ///< shot; empty: the session's
    bool keeps_failed = false;
    std::string command{};  ///< for the calibration
};

CLI::App& AddUnit(CLI::App& app, UnitOptions& options);

/// Measures where the cameras of one unit stand. 0: it may be driven with; 1: not, the reasons are
/// told and no calibration is written unless failed ones are kept; 2: wrong use, a bad session or
/// picture, or links between the cameras are missing; 3: a file could not be written.
int UnitVerb(const UnitOptions& options);

}  // namespace hitchview::app
