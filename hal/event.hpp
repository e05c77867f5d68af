#pragma once

#include <array>
#include <cstdint>

#include "hal/fixed_text.hpp"
#include "hal/frame.hpp"

namespace hitchview::hal {

/// What happened. The numbers stand on the wire: see lcmtypes/hitchview_event_t.lcm, which says how
/// they are given out.
enum class EventCode : std::int16_t {
    kCameraLost = 1,
    kCameraBack = 2,
    kRecordingStarted = 80,
    kRecordingStopped = 81,
    kRecordingFailed = 82,
    kRecordingDropped = 83,
};

inline constexpr std::array kEventCodes{EventCode::kCameraLost,       EventCode::kCameraBack,
                                        EventCode::kRecordingStarted, EventCode::kRecordingStopped,
                                        EventCode::kRecordingFailed,  EventCode::kRecordingDropped};

constexpr const char* ToString(EventCode code) {
    switch (code) {
        case EventCode::kCameraLost:
            return "camera_lost";
        case EventCode::kCameraBack:
            return "camera_back";
        case EventCode::kRecordingStarted:
            return "recording_started";
        case EventCode::kRecordingStopped:
            return "recording_stopped";
        case EventCode::kRecordingFailed:
            return "recording_failed";
        case EventCode::kRecordingDropped:
            return "recording_dropped";
    }
    return "unknown";
}

/// What and why, for a person.
using EventText = FixedText<96>;

/// Something that a person should know of, at the moment it happened.
struct Event {
    EventCode code = EventCode::kCameraLost;
    Instant when{};
    FixedText<64> subject{};  ///< whom it befell: a camera's name, a recording's file
    EventText text{};
};

}  // namespace hitchview::hal
