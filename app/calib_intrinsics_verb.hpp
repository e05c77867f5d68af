#pragma once

#include <CLI/CLI.hpp>
#include <filesystem>
#include <string>

#include "algo/camera_model.hpp"

namespace hitchview::app {

struct IntrinsicsOptions {
    std::string images{};            ///< pattern of the shell, as 'front/*.jpg': one camera
    std::filesystem::path folder{};  ///< instead: a folder of pictures for each camera, by its name
    std::string board{};             ///< as ReadBoard takes it
    algo::CameraModel::Kind model = algo::CameraModel::Kind::kKannalaBrandt4;
    std::filesystem::path out{};  ///< lens file, or the folder of those of all cameras; empty: none
    std::filesystem::path json{};  ///< all figures; empty: none
    bool keeps_failed = false;     ///< writes a lens file also with the verdict fail
    std::string command{};         ///< for the lens file
};

CLI::App& AddIntrinsics(CLI::App& app, IntrinsicsOptions& options);

/// Measures lenses from pictures of a board. 0: they may be driven with; 1: one may not, the
/// reasons are told; 2: wrong use, no picture, no board in any; 3: a file could not be written.
int IntrinsicsVerb(const IntrinsicsOptions& options);

}  // namespace hitchview::app
