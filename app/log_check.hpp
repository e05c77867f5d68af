#pragma once

#include <string_view>
#include <vector>

#include "app/log_channels.hpp"
#include "app/log_figures.hpp"
#include "app/log_streams.hpp"
#include "drivers/lcm_log_reader.hpp"

namespace hitchview::app {

/// Measures a recording, one event after another. Memory: eight bytes for each camera frame,
/// sixteen for each hitch angle and status.
class LogCheck {
 public:
    void Add(const drivers::LcmLogEvent& event);

    /// What only the recording as a whole tells (segments, bytes, damage) is left as it is.
    [[nodiscard]] LogFigures Figures() const;

 private:
    /// False if the message is not what its channel holds.
    bool AddMessage(const drivers::LcmLogEvent& event);
    bool AddImage(const drivers::LcmLogEvent& event);
    bool AddCanFrame(std::span<const std::uint8_t> message);
    bool AddHitchAngle(std::span<const std::uint8_t> message);
    bool AddStatus(std::span<const std::uint8_t> message);
    bool AddClock(std::span<const std::uint8_t> message);
    bool AddEvent(std::span<const std::uint8_t> message);
    bool AddRig(std::span<const std::uint8_t> message);
    void Count(const drivers::LcmLogEvent& event);
    CameraStream& Camera(std::string_view channel);
    [[nodiscard]] double Period_ms() const;
    void AddCameras(LogFigures& figures) const;

    LogChannels channels_;
    LogFigures counts_;  ///< what is counted while reading
    std::optional<double> rig_period_ms_;
    std::vector<CameraStream> cameras_;
    SequenceCounter images_;
    SequenceCounter status_;
    SequenceCounter hitch_angles_;
    SequenceCounter event_messages_;
    GapCounter can_gaps_{std::chrono::seconds(1)};
    ClockOffset clock_;
    ClockOffset status_clock_;  ///< stands in where the log has no readings of the clocks
    ArticulationComparison articulation_;
};

}  // namespace hitchview::app
