#pragma once

#include <array>
#include <cstdint>
#include <map>
#include <optional>
#include <string>
#include <vector>

#include "drivers/lcm_log_reader.hpp"

namespace hitchview::app {

/// Numbered messages of one channel.
struct SequenceFigures {
    std::uint64_t messages = 0;
    std::uint64_t lost = 0;    ///< numbers that are not there
    std::uint64_t gaps = 0;    ///< places where they are missing
    std::uint64_t resets = 0;  ///< how often the numbers began anew
};

struct CameraFigures {
    std::string channel;
    SequenceFigures frames;
    std::uint64_t time_gaps = 0;  ///< more than 1.5 periods between two frames
    std::optional<double> longest_gap_ms;
    std::optional<double> period_ms;  ///< from one sequence number to the next, on average
    std::optional<double> drift_ppm;  ///< of the period against the middle one; from 10 s on
};

/// Frames of the cameras, those that lie within half a period of each other put together.
struct SetFigures {
    std::uint64_t sets = 0;
    std::uint64_t complete = 0;    ///< with a frame of every camera
    std::optional<double> p50_ms;  ///< from the oldest to the newest frame of a set
    std::optional<double> p99_ms;
    std::optional<double> max_ms;
};

struct CanFigures {
    std::uint64_t frames = 0;  ///< of all kinds
    std::uint64_t errors = 0;  ///< error frames among them
    std::uint64_t gaps = 0;    ///< silences of more than a second
    std::optional<double> longest_gap_ms;
};

struct HitchAngleFigures {
    SequenceFigures messages;
    std::array<std::uint64_t, 5> qualities{};  ///< index: hal::HitchAngleQuality
    std::optional<double> least_rad;           ///< of the valid ones
    std::optional<double> most_rad;
};

/// Articulation from the images minus the vehicle's hitch angle at the same moment.
struct ArticulationFigures {
    std::uint64_t compared = 0;
    std::optional<double> median_rad;  ///< with its sign: how the two are turned to each other
    std::optional<double> median_abs_rad;
    std::optional<double> max_abs_rad;
};

struct PanoramaFigures {
    SequenceFigures images;
    SequenceFigures status;
    std::uint64_t deadline_misses = 0;  ///< as the last status tells
    std::uint64_t dropped = 0;
};

/// The wall clock against CLOCK_MONOTONIC.
struct ClockFigures {
    std::uint64_t readings = 0;
    std::uint64_t steps = 0;  ///< by more than 10 ms between two readings
    std::optional<double> largest_step_ms;
    std::uint64_t log_steps_back = 0;  ///< times of the log that are more than a second too early
};

struct ListedEvent {
    std::int64_t utime_us = 0;
    int code = 0;
    std::string subject;
    std::string text;
};

/// What is known about a recording. What cannot be known is empty, never invented.
struct LogFigures {
    std::size_t segments = 0;
    std::uint64_t bytes = 0;
    std::uint64_t events = 0;   ///< of the log
    std::int64_t first_us = 0;  ///< earliest and latest time of the log, since the epoch
    std::int64_t last_us = 0;
    std::map<std::string, std::uint64_t> channels;  ///< messages of each
    std::uint64_t undecodable = 0;  ///< messages that are not what their channel holds
    bool has_rig = false;
    std::string calibration_id;
    drivers::LcmLogDamage damage;
    double period_ms = 0;  ///< of the rig, else the middle one of the cameras; 0: not known

    std::vector<CameraFigures> cameras;
    SetFigures sets;
    CanFigures can;
    HitchAngleFigures hitch_angle;
    ArticulationFigures articulation;
    PanoramaFigures panoramas;
    ClockFigures clock;
    std::vector<ListedEvent> listed_events;  ///< the first thousand
    SequenceFigures event_messages;

    [[nodiscard]] double Duration_s() const {
        return (static_cast<double>(last_us) - static_cast<double>(first_us)) / 1e6;
    }
};

}  // namespace hitchview::app
