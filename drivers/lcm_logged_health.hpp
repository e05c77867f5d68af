#pragma once

#include <cstdint>
#include <span>
#include <string_view>
#include <vector>

#include "hal/frame.hpp"
#include "hal/result.hpp"

namespace hitchview::drivers {

// What a program says of itself, read without trust: types in lcmtypes/ say what the values mean.
// What is returned borrows the message. kCorrupted: wrong type, a count or length that is negative,
// too large or reaches past the end, bytes left over, or a value outside its range.

inline constexpr int kMostHealthCameras = 32;
inline constexpr int kMostHealthStages = 32;
inline constexpr int kMostHealthTextBytes = 1024;  ///< of each text

struct LoggedCameraHealth {
    std::string_view name{};
    std::string_view unit{};
    bool shown = false;
    std::int8_t state = 0;    ///< of hal::CameraState, or one that is not known yet
    double frames_per_s = 0;  ///< finite, not below 0
    double age_ms = 0;        ///< below 0, or not a number: no frame yet
    std::int64_t delivered = 0;
    std::int64_t lost = 0;
    std::int64_t corrupted = 0;
    std::int64_t reopened = 0;
};

/// Times may be not a number: a stage that was never timed.
struct LoggedStageTime {
    std::string_view name{};
    double last_ms = 0;
    double p50_ms = 0;
    double p99_ms = 0;
    double max_ms = 0;
};

/// A hitchview.health_t.
struct LoggedHealth {
    std::uint32_t sequence = 0;
    std::int64_t utime_us = 0;
    hal::Instant monotonic{};
    std::string_view version{};
    std::string_view calibration_id{};
    double uptime_s = 0;
    double panoramas_per_s = 0;
    std::int64_t panoramas = 0;
    std::int64_t dropped = 0;
    std::int64_t deadline_misses = 0;
    std::int64_t events_lost = 0;
    std::int32_t image_bytes = 0;
    std::int32_t image_budget_bytes = 0;
    std::int32_t image_quality = 0;
    std::int32_t receive_buffer_bytes = 0;
    std::string_view warning{};
    std::int64_t rss_bytes = 0;
    std::int64_t minor_faults = 0;
    std::int64_t major_faults = 0;
    std::int64_t heap_calls = 0;
    std::int8_t recording = 0;  ///< HITCHVIEW_HEALTH_T_RECORDING_*
    std::int64_t recorded_bytes = 0;
    std::int64_t recording_dropped = 0;
    std::int64_t disk_free_bytes = 0;
    std::vector<LoggedCameraHealth> cameras{};  ///< at most kMostHealthCameras
    std::vector<LoggedStageTime> stages{};      ///< at most kMostHealthStages
};
hal::Result<LoggedHealth> ParseLoggedHealth(std::span<const std::uint8_t> message);

}  // namespace hitchview::drivers
