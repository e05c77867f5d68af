#pragma once

#include <cstdint>
#include <optional>
#include <span>
#include <string_view>
#include <vector>

#include "hal/can_bus.hpp"
#include "hal/frame.hpp"
#include "hal/hitch_angle.hpp"
#include "hal/publisher.hpp"
#include "hal/result.hpp"

namespace hitchview::drivers {

// Messages of a log, read without trust: types in lcmtypes/ say what the values mean. All parsers:
// what they return borrows the message; kCorrupted: wrong type, a count or length that is negative
// or reaches past the end, bytes left over, or a value outside its range (times since the epoch
// up to the year 2255, CLOCK_MONOTONIC up to a century).

/// What a message says that it is, by the fingerprint that it begins with.
enum class LoggedKind {
    kUnknown,
    kImage,
    kCanFrame,
    kHitchAngle,
    kStatus,
    kClock,
    kEvent,
    kRig,
};
LoggedKind KindOf(std::span<const std::uint8_t> message);

/// A bot_core.image_t: a panorama, a camera's frame, or a picture of someone else's.
struct LoggedImage {
    std::int64_t utime_us = 0;
    int width_px = 0;          ///< [1, 16384]
    int height_px = 0;         ///< [1, 16384]
    int row_stride_bytes = 0;  ///< 0 for a compressed picture
    std::int32_t fourcc = 0;   ///< BOT_CORE_IMAGE_T_PIXEL_FORMAT_*
    std::span<const std::uint8_t> data{};
    std::optional<std::uint32_t> sequence{};    ///< property `sequence`
    std::optional<hal::Instant> captured_at{};  ///< `captured_ns`, or `captured_from_ns`
    hal::Range range = hal::Range::kFull;       ///< property `range`: full or limited
};
hal::Result<LoggedImage> ParseLoggedImage(std::span<const std::uint8_t> message);

/// A hitchview.can_frame_t.
struct LoggedCanFrame {
    std::string_view bus{};
    hal::CanFrame frame;  ///< `epoch` is its utime
};
hal::Result<LoggedCanFrame> ParseLoggedCanFrame(std::span<const std::uint8_t> message);

/// A hitchview.hitch_angle_t.
struct LoggedHitchAngle {
    std::uint32_t sequence = 0;
    std::int64_t utime_us = 0;
    hal::HitchAngle angle;
};
hal::Result<LoggedHitchAngle> ParseLoggedHitchAngle(std::span<const std::uint8_t> message);

/// A hitchview.panorama_status_t.
struct LoggedStatus {
    std::int64_t utime_us = 0;
    hal::PanoramaStatus status;
};
hal::Result<LoggedStatus> ParseLoggedStatus(std::span<const std::uint8_t> message);

/// A hitchview.clock_t.
struct LoggedClock {
    std::int64_t utime_us = 0;
    hal::Instant monotonic{};
};
hal::Result<LoggedClock> ParseLoggedClock(std::span<const std::uint8_t> message);

/// A hitchview.event_t.
struct LoggedEvent {
    std::uint32_t sequence = 0;
    std::int64_t utime_us = 0;
    std::int16_t code = 0;
    std::string_view subject{};
    std::string_view text{};
};
hal::Result<LoggedEvent> ParseLoggedEvent(std::span<const std::uint8_t> message);

/// A hitchview.rig_t.
struct LoggedRig {
    std::int64_t utime_us = 0;
    std::string_view rig_yaml{};
    std::string_view calibration_yaml{};
    std::string_view calibration_id{};
    std::vector<std::string_view> cameras{};          ///< at most 32
    std::vector<std::string_view> camera_channels{};  ///< as many
    double period_ms = 0;                             ///< finite, above 0
};
hal::Result<LoggedRig> ParseLoggedRig(std::span<const std::uint8_t> message);

}  // namespace hitchview::drivers
