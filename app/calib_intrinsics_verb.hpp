#pragma once

#include <filesystem>
#include <string>

#include "algo/camera_model.hpp"

namespace hitchview::app {

struct IntrinsicsOptions {
    std::string images{};  ///< pattern of the shell, as 'front/*.jpg'
    std::string board{};   ///< COLSxROWS,SQUARE_M
    algo::CameraModel::Kind model = algo::CameraModel::Kind::kKannalaBrandt4;
    std::filesystem::path out{};   ///< lens file; empty: none
    std::filesystem::path json{};  ///< all figures; empty: none
    std::string command{};         ///< for the lens file
};

/// Measures a lens from pictures of a chessboard. 0: it may be driven with; 1: not, the reasons are
/// told; 2: wrong use, no picture, no board in any; 3: a file could not be written.
int IntrinsicsVerb(const IntrinsicsOptions& options);

}  // namespace hitchview::app
