#pragma once

#include <atomic>
#include <filesystem>

#include "drivers/simulated_rig.hpp"

namespace hitchview::app {

/// The simulated drive as files that a real rig could have written: per camera a folder of JPEG
/// pictures, the CAN bus as a candump log, rig file and calibration.
struct DemoRecording {
    std::filesystem::path folder;

    [[nodiscard]] std::filesystem::path rig() const { return folder / "rig.yaml"; }
    /// The same rig with stabilisation and stitching switched off.
    [[nodiscard]] std::filesystem::path plain_rig() const {
        return folder / "rig_without_uvm.yaml";
    }
    [[nodiscard]] std::filesystem::path picture(int camera, int frame) const;
};

/// Renders what is not there yet, with a progress bar on stderr when that is a terminal; a complete
/// recording of the same options is used again. Error: the disk refuses, or `stop` was set.
hal::Checked<DemoRecording> RecordDemo(const drivers::SimulatedRig& rig,
                                       const std::filesystem::path& folder,
                                       const std::atomic<bool>& stop);

}  // namespace hitchview::app
