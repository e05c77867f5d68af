#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "calib/format.hpp"

namespace hitchview::app {

struct CalibImportOptions {
    calib::Format format = calib::Format::kOpenCv;
    std::vector<std::filesystem::path> in{};
    std::filesystem::path out{};
    calib::ImportHints hints{};
    /// tractor or trailer: one for all files, or one for each; none: a lens is imported.
    std::vector<std::string> units{};
    std::string vehicle = "imported";
    std::string camera{};        ///< the only one to take; empty: all
    std::string first_camera{};  ///< X,Y,Z,ROLL,PITCH,YAW of the first camera; empty: not given
    std::string command{};       ///< for the file
};

/// Makes a lens file, or a rig calibration where units are given, of files of other programs.
/// 0: done; 2: wrong use or a bad file; 3: the file could not be written.
int CalibImportVerb(const CalibImportOptions& options);

struct CalibExportOptions {
    calib::Format format = calib::Format::kOpenCv;
    std::filesystem::path calibration{};  ///< one of these two
    std::filesystem::path lens{};
    std::filesystem::path out{};  ///< folder; of a lens a file or an existing folder
};

/// Writes a lens or a whole rig as other programs read it. Nothing is written unless all can be.
/// 0: done; 2: wrong use, a bad file, or a lens that the format cannot hold; 3: a file could not be
/// written.
int CalibExportVerb(const CalibExportOptions& options);

}  // namespace hitchview::app
