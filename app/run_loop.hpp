#pragma once

#include <atomic>
#include <chrono>
#include <filesystem>
#include <functional>
#include <optional>
#include <string>
#include <vector>

#include "algo/paper_stages.hpp"
#include "app/config.hpp"
#include "app/event_queue.hpp"
#include "app/fault_script.hpp"
#include "app/heap_calls.hpp"
#include "app/live_frame_synchronizer.hpp"
#include "app/pipeline.hpp"
#include "app/recorder.hpp"
#include "app/resources.hpp"

namespace hitchview::app {

/// What long work has done so far: a step and its frame sets.
using ProgressHook = std::function<void(const char* step, std::uint64_t frames)>;

struct RunOptions {
    std::filesystem::path out{};  ///< folder for report and videos; empty: none are written
    std::optional<int> frames{};  ///< at most so many frame sets
    /// At most so long: of time for live cameras, otherwise of the recording or simulation.
    std::optional<std::chrono::nanoseconds> duration{};
    std::optional<int> lookahead_frames{};  ///< instead of the rig file's
    std::optional<int> workers{};           ///< instead of the rig file's
    bool offline =
        false;  ///< recordings are read twice, and all of them is seen before any is shown
    algo::Coupling coupling = algo::Coupling::kCorrected;  ///< offline
    ProgressHook progress{};                               ///< offline
    bool realtime = false;     ///< not offline; one frame set per period; late ones are dropped
    double speed = 1;          ///< realtime: of recordings, times their own. [0.1, 10]
    bool write_video = false;  ///< out/panorama.avi
    bool write_views = false;  ///< out/tractor.avi, out/trailer.avi
    bool publish = false;      ///< over LCM
    bool record = false;       ///< where the rig file says so
    std::atomic<bool>* trigger = nullptr;  ///< of the recorder; see RecorderOptions
    std::optional<FaultScript> faults{};   ///< that happen to the cameras
    bool trap_alloc = false;               ///< the first heap call after READY stops the program
};

/// The articulation over a run, as the images told it.
struct ArticulationSummary {
    std::uint64_t frames = 0;  ///< panoramas at which it was known
    double least_rad = 0;      ///< angles, positive to the left; 0 while never known
    double most_rad = 0;
    double variances = 0;  ///< sum over `frames`, rad^2

    void Add(const algo::Articulation& articulation);
};

/// Memory from READY to the last panorama.
struct MemorySummary {
    std::optional<HeapCallCounts> heap_calls{};  ///< empty where they cannot be counted
    Resources at_ready{};
    Resources at_end{};
};

struct PoolSummary {
    std::string name;
    hal::PoolLevel level;
};

/// What became of the frames of the CAN bus.
struct CanSummary {
    std::uint64_t frames = 0;          ///< received
    std::uint64_t angles = 0;          ///< handed to the publisher, those without a value too
    std::uint64_t angles_refused = 0;  ///< lost: the publisher was too slow
    std::uint64_t dropped = 0;         ///< frames that the kernel had no room for
    std::uint64_t errors = 0;          ///< error frames
    std::uint64_t disconnections = 0;
};

/// What a run did.
struct RunSummary {
    std::uint64_t frames = 0;           ///< panoramas shown
    std::uint64_t dropped = 0;          ///< frame sets never shown
    std::uint64_t lightened = 0;        ///< frame sets whose inter matching was left out
    std::uint64_t deadline_misses = 0;  ///< frame sets that took longer than a period
    double period_ms = 0;
    double duration_s = 0;  ///< from the first frame set to the last panorama
    std::string calibration_id;
    double newest_total_ms = 0;        ///< of the frame set processed last
    AllStageTimes times{};             ///< when the run has ended
    PublishTimes publishing{};         ///< same
    std::vector<PoolSummary> pools{};  ///< same
    algo::PerOverlap<std::uint64_t> locked_frames;
    ArticulationSummary articulation{};
    algo::PerUnit<int> cameras;
    MemorySummary memory{};
    std::optional<CanSummary> can{};  ///< when the run has ended; empty where no bus was read
    std::optional<RecordingSummary> recording{};  ///< when the run has ended
    bool ring = false;
    EventCounts events{};               ///< when the run has ended
    std::optional<LiveSummary> live{};  ///< of cameras that run at their own pace
};

/// Sees every panorama that is shown, in order. Thread: the run loop's.
using ShownHook = std::function<void(const ShownPanorama&, const Pipeline&)>;

/// Opens the rig and makes panoramas until the sources end, `options.frames` sets were taken or
/// `stop` is set. Error: what is wrong with rig, recordings, outputs or network, in words; nothing
/// is written when the rig or its recordings cannot be opened.
hal::Checked<RunSummary> RunRig(const RigConfig& config, const RunOptions& options,
                                const std::atomic<bool>& stop, const ShownHook& hook = {});

}  // namespace hitchview::app
