#pragma once

#include <filesystem>
#include <string>

#include "hal/result.hpp"

namespace hitchview::app {

struct SimulatedBoardOptions {
    std::string scenario = "slalom";
    int frames = 300;            ///< [1, 36000]; not if it is live
    int camera_width_px = 1280;  ///< 16:9
    int loop_frames = 0;         ///< as simulation.loop_frames; 0: the whole drive
    bool live = false;           ///< as simulation.live; with loop_frames only
};

/// Writes rig file and calibration of the built-in rig: the simulated vehicle with its eight
/// cameras and its CAN bus. Returns the rig file. Error: the disk refuses.
hal::Checked<std::filesystem::path> WriteSimulatedBoard(const SimulatedBoardOptions& options,
                                                        const std::filesystem::path& folder);

}  // namespace hitchview::app
