#pragma once

#include <memory>
#include <vector>

#include "app/config.hpp"
#include "app/event_queue.hpp"
#include "app/frame_tap.hpp"
#include "app/live_frame_synchronizer.hpp"
#include "app/recorded_frame_synchronizer.hpp"
#include "app/rig_geometry.hpp"
#include "hal/camera.hpp"
#include "hal/can_bus.hpp"
#include "hal/clock.hpp"
#include "hal/publisher.hpp"
#include "hal/watchdog.hpp"

namespace hitchview::drivers {
class LcmLogCanBus;
struct SheetOptions;
}  // namespace hitchview::drivers

namespace hitchview::app {

class SimulatedDevices;
struct FaultScript;
struct LogCamera;

/// The hardware of one rig, opened: real, recorded or simulated. Everything else of the program
/// sees interfaces only.
class Board {
 public:
    struct Options {
        int held_frames = 2;    ///< frame sets that the program keeps lent
        bool recorded = false;  ///< cameras have taps, and a live CAN bus delivers all its frames
        /// Live cameras (V4L2) that cannot be opened are lost from the start, and had when they
        /// come, if any other can be; false: they are an error.
        bool awaits_cameras = false;
        /// What happens to the cameras; null: nothing. Borrowed by Open.
        const FaultScript* faults = nullptr;
        /// What somebody holds before each simulated camera; null: nothing. Borrowed by Open.
        const drivers::SheetOptions* held_sheet = nullptr;
    };
    /// Opens what the configuration names. `earlier`: a board of the same rig, which ends; frames
    /// that it rendered for a loop are shown again.
    static hal::Checked<std::unique_ptr<Board>> Open(const RigConfig& config,
                                                     const Options& options,
                                                     std::unique_ptr<Board> earlier = nullptr);
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
    /// Live cameras that could not be opened yet: bits of cameras_missing.
    [[nodiscard]] std::uint32_t cameras_awaited() const { return cameras_awaited_; }
    /// Of each camera, in the order of the bits of cameras_missing; empty unless it is recorded.
    [[nodiscard]] const std::vector<FrameTap*>& taps() const { return taps_; }

    hal::Checked<std::unique_ptr<hal::Publisher>> OpenPublisher(const PublishConfig& config);
    /// Of the service manager that started this program; null: none did.
    static hal::Checked<std::unique_ptr<hal::Watchdog>> OpenWatchdog();
    /// What this system grants a subscriber that asks for a large receive buffer; empty: not known.
    [[nodiscard]] static std::optional<int> ReceiveBufferBytes();

 private:
    explicit Board(const Options& options);
    hal::Checked<hal::Done> OpenCamera(const RigConfig& config, algo::Unit unit,
                                       const CameraConfig& camera, int slots);
    hal::Checked<hal::Done> OpenLiveCameras(const RigConfig& config, int slots);
    hal::Checked<hal::Done> OpenLiveSimulation(const RigConfig& config, int slots);
    void OpenLogCamera(const RigConfig& config, algo::Unit unit, const CameraConfig& camera,
                       int slots);
    hal::Camera& Add(algo::Unit unit, const std::string& name, std::unique_ptr<hal::Camera> camera);
    std::unique_ptr<hal::Camera> WithFaults(const std::string& name,
                                            std::unique_ptr<hal::Camera> camera);
    void StartSets(const RigConfig& config);
    hal::Checked<hal::Done> OpenCanBus(const RigConfig& config);
    hal::Checked<hal::Done> OpenSocketCan(const RigConfig& config);

    const Options options_;
    std::unique_ptr<hal::Clock> clock_;
    std::unique_ptr<SimulatedDevices> simulation_;  ///< null: nothing is simulated
    Cameras cameras_;
    std::vector<FrameTap*> taps_;
    std::vector<LiveCamera> live_cameras_;
    std::uint32_t cameras_awaited_ = 0;
    std::vector<LogCamera> log_cameras_;
    std::unique_ptr<hal::CanBus> can_bus_;
    drivers::LcmLogCanBus* log_can_bus_ = nullptr;  ///< the same, of a recording
    bool is_can_live_ = false;
    bool is_live_ = false;
    hal::Instant period_{};
    std::unique_ptr<hal::EventLog> event_log_;
    EventQueue events_;
    std::unique_ptr<FrameSynchronizer> sets_;  // last: it uses cameras, events and clock
    LiveFrameSynchronizer* live_ = nullptr;
};

}  // namespace hitchview::app
