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
    kCameraLate = 3,
    kCameraDisordered = 4,
    kCameraBlack = 5,
    kCameraBlinded = 6,
    kCameraFrozen = 7,
    kCameraStuck = 8,
    kCameraBlurred = 9,
    kCameraDirty = 10,
    kSeamLocked = 20,
    kSeamCoast = 21,
    kSeamReacquire = 22,
    kSeamNoOverlap = 23,
    kCalibrationMismatch = 40,
    kDeadlineMissed = 60,
    kDeadlineKept = 61,
    kPanoramasDropped = 62,
    kReceiveBufferSmall = 63,
    kRecordingStarted = 80,
    kRecordingStopped = 81,
    kRecordingFailed = 82,
    kRecordingDropped = 83,
};

/// In the order of their numbers.
inline constexpr std::array kEventCodes{
    EventCode::kCameraLost,          EventCode::kCameraBack,         EventCode::kCameraLate,
    EventCode::kCameraDisordered,    EventCode::kCameraBlack,        EventCode::kCameraBlinded,
    EventCode::kCameraFrozen,        EventCode::kCameraStuck,        EventCode::kCameraBlurred,
    EventCode::kCameraDirty,         EventCode::kSeamLocked,         EventCode::kSeamCoast,
    EventCode::kSeamReacquire,       EventCode::kSeamNoOverlap,      EventCode::kCalibrationMismatch,
    EventCode::kDeadlineMissed,      EventCode::kDeadlineKept,       EventCode::kPanoramasDropped,
    EventCode::kReceiveBufferSmall,  EventCode::kRecordingStarted,   EventCode::kRecordingStopped,
    EventCode::kRecordingFailed,     EventCode::kRecordingDropped};

constexpr const char* ToString(EventCode code) {
    switch (code) {
        case EventCode::kCameraLost:
            return "camera_lost";
        case EventCode::kCameraBack:
            return "camera_back";
        case EventCode::kCameraLate:
            return "camera_late";
        case EventCode::kCameraDisordered:
            return "camera_disordered";
        case EventCode::kCameraBlack:
            return "camera_black";
        case EventCode::kCameraBlinded:
            return "camera_blinded";
        case EventCode::kCameraFrozen:
            return "camera_frozen";
        case EventCode::kCameraStuck:
            return "camera_stuck";
        case EventCode::kCameraBlurred:
            return "camera_blurred";
        case EventCode::kCameraDirty:
            return "camera_dirty";
        case EventCode::kSeamLocked:
            return "seam_locked";
        case EventCode::kSeamCoast:
            return "seam_coast";
        case EventCode::kSeamReacquire:
            return "seam_reacquire";
        case EventCode::kSeamNoOverlap:
            return "seam_no_overlap";
        case EventCode::kCalibrationMismatch:
            return "calibration_mismatch";
        case EventCode::kDeadlineMissed:
            return "deadline_missed";
        case EventCode::kDeadlineKept:
            return "deadline_kept";
        case EventCode::kPanoramasDropped:
            return "panoramas_dropped";
        case EventCode::kReceiveBufferSmall:
            return "receive_buffer_small";
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
using EventText = FixedText<192>;

/// Something that a person should know of, at the moment it happened.
struct Event {
    EventCode code = EventCode::kCameraLost;
    Instant when{};
    /// Whom it befell: the name of a camera, left or right of a seam, a recording's file.
    FixedText<64> subject{};
    EventText text{};
};

}  // namespace hitchview::hal
