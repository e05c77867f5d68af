#pragma once

#include <memory>
#include <string>

#include "app/config.hpp"
#include "drivers/looped_frames.hpp"
#include "drivers/simulated_rig.hpp"
#include "hal/camera.hpp"
#include "hal/can_bus.hpp"
#include "hal/clock.hpp"

namespace hitchview::app {

/// The simulated vehicle of a rig file, as the board's devices see it: a drive, or a loop of its
/// first frames. It must outlive the devices that it opens.
class SimulatedDevices {
 public:
    /// Null where the rig has nothing simulated. `held_sheet`: before each camera, or null.
    /// `earlier`: of the same rig, or null; the loop that it rendered is shown again.
    static hal::Checked<std::unique_ptr<SimulatedDevices>> Open(
        const RigConfig& config, const drivers::SheetOptions* held_sheet,
        std::unique_ptr<SimulatedDevices> earlier);

    /// As fast as it is read, a few frames ahead of the reader. Error: no such camera there.
    [[nodiscard]] hal::Checked<std::unique_ptr<hal::Camera>> OpenCamera(algo::Unit unit,
                                                                        const std::string& name,
                                                                        int slots) const;
    /// At the pace of `clock`, from its moment `start` on; of a loop only.
    [[nodiscard]] hal::Checked<std::unique_ptr<hal::Camera>> OpenLiveCamera(
        algo::Unit unit, const std::string& name, int slots, hal::Instant start,
        hal::Clock& clock) const;
    /// As fast as it is read; where the simulation is live, at the pace of `clock`.
    [[nodiscard]] std::unique_ptr<hal::CanBus> OpenCanBus(hal::Clock& clock) const;

 private:
    SimulatedDevices(const RigConfig& config, std::unique_ptr<drivers::SimulatedRig> rig,
                     std::unique_ptr<drivers::LoopedFrames> loop);
    [[nodiscard]] hal::Checked<int> Find(algo::Unit unit, const std::string& name) const;
    [[nodiscard]] int RunFrames() const;

    std::string file_;  // for errors
    SimulationConfig config_;
    std::unique_ptr<drivers::SimulatedRig> rig_;
    std::unique_ptr<drivers::LoopedFrames> loop_;  // null: the whole drive
};

}  // namespace hitchview::app
