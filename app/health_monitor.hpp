#pragma once

#include <array>
#include <optional>
#include <string>
#include <vector>

#include "app/frame_figures.hpp"
#include "app/recorder.hpp"
#include "app/resources.hpp"
#include "hal/camera.hpp"
#include "hal/health.hpp"

namespace hitchview::app {

/// A camera whose health is told.
struct WatchedCamera {
    std::string name;
    algo::Unit unit = algo::Unit::kTractor;
    /// Counts its frames; null for recordings, whose frames are counted by the sets they are in.
    const hal::Camera* device = nullptr;
};

/// What is referred to must outlive the monitor.
struct HealthOptions {
    std::string version;
    std::string calibration_id;
    std::vector<WatchedCamera> cameras;  ///< in the order of the bits of cameras_missing
    bool paced = true;  ///< capture times are the clock's; otherwise nobody knows a frame's age
    const Recorder* recorder = nullptr;  ///< null: nothing is recorded
};

/// Gathers what a health message tells. All memory is taken at construction. Thread: one; the
/// figures of cameras and heap are read as other threads count them.
class HealthMonitor {
 public:
    explicit HealthMonitor(const HealthOptions& options);

    /// Counts begin here.
    void Start(hal::Instant now, const Resources& resources);
    void Add(const FrameFigures& figures);
    /// Everything but what its sender knows. Rates are since the call before.
    hal::Health Measure(hal::Instant now);

 private:
    struct CameraState {
        WatchedCamera camera;
        std::uint64_t sets = 0;    ///< that it was in
        std::uint64_t before = 0;  ///< frames at the measurement before
        std::optional<hal::Instant> newest{};
        bool shown = false;
        hal::CameraState condition = hal::CameraState::kGood;
    };
    hal::CameraHealth Measure(CameraState& state, hal::Instant now, double seconds);
    void AddMemory(hal::Health& health) const;

    HealthOptions options_;
    std::vector<CameraState> cameras_;
    AllStageTimes times_{};
    FrameFigures newest_{};
    Resources at_start_{};
    hal::Instant start_{};
    hal::Instant measured_at_{};
    std::uint64_t panoramas_before_ = 0;
};

/// One stage's line of a health message.
hal::StageHealth StageHealthOf(std::string_view name, const StageTimes& times);

}  // namespace hitchview::app
