#pragma once

#include <memory>
#include <vector>

#include "app/config.hpp"
#include "app/event_queue.hpp"
#include "app/live_frame_synchronizer.hpp"
#include "app/recorded_frame_synchronizer.hpp"
#include "app/rig_geometry.hpp"
#include "hal/camera.hpp"
#include "hal/can_bus.hpp"
#include "hal/clock.hpp"
#include "hal/publisher.hpp"

namespace hitchview::drivers {
class SimulatedRig;
}

namespace hitchview::app {

/// The hardware of one rig, opened: real, recorded or simulated. Everything else of the program
/// sees interfaces only.
class Board {
 public:
    /// Opens what the configuration names. `held_frames`: frame sets that the program keeps lent.
    static hal::Checked<std::unique_ptr<Board>> Open(const RigConfig& config, int held_frames);
    ~Board();
    Board(const Board&) = delete;
    Board& operator=(const Board&) = delete;

    [[nodiscard]] Cameras& cameras() { return cameras_; }
    /// Frame sets of its cameras; those of recordings start with the first frames.
    [[nodiscard]] FrameSynchronizer& sets() { return *sets_; }
    /// The same where the cameras run at their own pace, otherwise null: recordings and simulations
    /// deliver as fast as they are read.
    [[nodiscard]] LiveFrameSynchronizer* live() { return live_; }
    /// What happens to its devices, and for whoever else has something to tell.
    [[nodiscard]] EventQueue& events() { return events_; }
    /// Null when the rig names no CAN bus.
    [[nodiscard]] hal::CanBus* can_bus() { return can_bus_.get(); }
    /// Whether its frames are received at moments of this machine's clock, not of a recording.
    [[nodiscard]] bool is_can_live() const { return is_can_live_; }
    [[nodiscard]] hal::Clock& clock() { return *clock_; }
    /// Time from one frame set to the next.
    [[nodiscard]] hal::Instant period() const { return period_; }
    [[nodiscard]] CameraFormats formats() const;

    hal::Checked<std::unique_ptr<hal::Publisher>> OpenPublisher(const PublishConfig& config);
    /// What this system grants a subscriber that asks for a large receive buffer; empty: not known.
    [[nodiscard]] static std::optional<int> ReceiveBufferBytes();

 private:
    Board();
    hal::Checked<hal::Done> OpenSimulation(const RigConfig& config);
    hal::Checked<hal::Done> OpenCamera(const RigConfig& config, algo::Unit unit,
                                       const CameraConfig& camera, int slots);
    hal::Checked<hal::Done> OpenLiveCamera(const RigConfig& config, algo::Unit unit,
                                           const CameraConfig& camera, int slots);
    void StartSets(const RigConfig& config);
    hal::Checked<hal::Done> OpenCanBus(const RigConfig& config);
    hal::Checked<hal::Done> OpenSocketCan(const RigConfig& config);

    std::unique_ptr<hal::Clock> clock_;
    std::unique_ptr<drivers::SimulatedRig> simulation_;
    Cameras cameras_;
    std::vector<LiveCamera> live_cameras_;
    std::unique_ptr<hal::CanBus> can_bus_;
    bool is_can_live_ = false;
    hal::Instant period_{};
    EventQueue events_;
    std::unique_ptr<FrameSynchronizer> sets_;  // last: it uses cameras, events and clock
    LiveFrameSynchronizer* live_ = nullptr;
};

}  // namespace hitchview::app
