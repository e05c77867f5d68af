#pragma once

#include <CLI/CLI.hpp>
#include <filesystem>
#include <string>
#include <vector>

namespace hitchview::app {

struct VerifyOptions {
    std::filesystem::path calibration{};
    std::filesystem::path pictures{};           ///< a folder for each camera, by its name
    std::vector<std::filesystem::path> logs{};  ///< instead: a recorded drive
    std::vector<std::string> boards{};          ///< that are in them
    std::filesystem::path rig{};                ///< whose panorama it is; empty: 4096 x 720
    std::filesystem::path json{};               ///< all figures; empty: none
    std::filesystem::path view{};               ///< folder for pictures to look at; empty: none
    std::string command{};                      ///< for the figures
};

CLI::App& AddVerify(CLI::App& app, VerifyOptions& options);

/// Compares a calibration with fresh pictures. 0: it still holds; 1: not, and why; 2: wrong use, a
/// bad calibration or picture; 3: a file could not be written.
int VerifyVerb(const VerifyOptions& options);

}  // namespace hitchview::app
