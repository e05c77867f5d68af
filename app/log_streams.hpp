#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "app/log_figures.hpp"
#include "drivers/lcm_log_messages.hpp"

namespace hitchview::app {

/// Counts what is missing in numbers that should go up by one, modulo 2^32.
class SequenceCounter {
 public:
    void Add(std::uint32_t sequence);
    /// A message without a number.
    void AddUnnumbered() { ++figures_.messages; }
    [[nodiscard]] const SequenceFigures& figures() const { return figures_; }
    /// From the number before to the newest; empty for the first and after a reset.
    [[nodiscard]] std::optional<std::uint32_t> step() const { return step_; }

 private:
    SequenceFigures figures_;
    std::optional<std::uint32_t> last_;
    std::optional<std::uint32_t> step_;
};

/// Longest silence of a channel, and how many were longer than a bound.
class GapCounter {
 public:
    explicit GapCounter(hal::Instant bound) : bound_(bound) {}
    void Add(hal::Instant at);
    [[nodiscard]] std::uint64_t gaps() const { return gaps_; }
    [[nodiscard]] std::optional<double> longest_ms() const;

 private:
    hal::Instant bound_;
    std::optional<hal::Instant> last_;
    std::optional<hal::Instant> longest_;
    std::uint64_t gaps_ = 0;
};

/// One camera's frames: 8 bytes of memory each.
class CameraStream {
 public:
    explicit CameraStream(std::string channel) : channel_(std::move(channel)) {}

    void Add(const drivers::LoggedImage& image);
    [[nodiscard]] const std::string& channel() const { return channel_; }
    /// When each was captured, in the order of the log.
    [[nodiscard]] const std::vector<hal::Instant>& times() const { return times_; }
    /// Empty below ten steps of the sequence numbers.
    [[nodiscard]] std::optional<double> Period_ms() const;
    /// Without the drift. `period_ms`: of the rig; 0: not known, no time gaps then.
    [[nodiscard]] CameraFigures Figures(double period_ms) const;

 private:
    std::string channel_;
    SequenceCounter sequence_;
    std::vector<hal::Instant> times_;
    hal::Instant stepped_time_{};  ///< of all steps between neighbouring frames
    std::uint64_t steps_ = 0;
};

/// Steps of the wall clock against the monotonic one.
class ClockOffset {
 public:
    void Add(std::int64_t utime_us, hal::Instant monotonic);
    void AddLogTime(std::int64_t utime_us);
    [[nodiscard]] const ClockFigures& figures() const { return figures_; }

 private:
    ClockFigures figures_;
    std::optional<hal::Instant> offset_;
    std::optional<std::int64_t> latest_us_;
};

/// Articulation as the images tell it beside the vehicle's angle, between whose values lines are
/// drawn; no comparison across more than half a second without one.
class ArticulationComparison {
 public:
    void Add(const hal::HitchAngle& angle);
    void Add(const hal::PanoramaStatus& status);
    [[nodiscard]] ArticulationFigures Figures() const;

 private:
    struct Angle {
        hal::Instant at;
        double rad;
    };
    std::vector<Angle> vehicle_;
    std::vector<Angle> images_;
};

}  // namespace hitchview::app
