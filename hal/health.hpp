#pragma once

#include <array>
#include <cstdint>

#include "hal/camera_state.hpp"
#include "hal/event.hpp"
#include "hal/fixed_text.hpp"
#include "hal/frame.hpp"

namespace hitchview::hal {

/// How one camera of the rig does.
struct CameraHealth {
    FixedText<64> name{};         ///< in the rig file
    FixedText<16> unit{};         ///< tractor or trailer
    bool shown = false;           ///< its frames are in the newest panorama
    CameraState state = CameraState::kGood;
    double frames_per_s = 0;      ///< that came in the last second
    double age_ms = -1;           ///< since the newest exposure; below 0 before the first
    std::uint64_t delivered = 0;  ///< frames, since it was opened first
    std::uint64_t lost = 0;       ///< gaps of the device's numbers
    std::uint64_t corrupted = 0;  ///< came, and were damaged
    std::uint64_t reopened = 0;   ///< how often the device came back
};

/// How long one stage of the work on a panorama takes, since the start.
struct StageHealth {
    FixedText<16> name{};
    double last_ms = 0;
    double p50_ms = 0;
    double p99_ms = 0;
    double max_ms = 0;
};

/// The numbers stand on the wire: see lcmtypes/hitchview_health_t.lcm.
enum class RecordingState : std::uint8_t { kOff = 0, kArmed = 1, kOn = 2, kStopped = 3 };

/// Of the recorder, if there is one.
struct RecordingHealth {
    RecordingState state = RecordingState::kOff;
    std::uint64_t recorded_bytes = 0;  ///< since the program was ready
    std::uint64_t dropped = 0;         ///< messages that the recording lacks
    std::int64_t disk_free_bytes = -1;
};

/// A list without the heap; what does not fit is left out.
template <typename T, int kMost>
struct HealthList {
    std::array<T, kMost> items{};
    int count = 0;

    void Add(const T& item) {
        if (count < kMost) items[static_cast<std::size_t>(count++)] = item;
    }
};

/// How the program does, all figures in memory of their own. "Since the start" is since READY.
struct Health {
    Instant measured_at{};
    FixedText<32> version{};
    FixedText<64> calibration_id{};  ///< empty for a rig without calibration
    double uptime_s = 0;
    double panoramas_per_s = 0;  ///< shown in the last second
    std::uint64_t panoramas = 0;
    std::uint64_t dropped = 0;          ///< frame sets never shown
    std::uint64_t deadline_misses = 0;  ///< panoramas that took longer than a period
    std::uint64_t events_lost = 0;      ///< came faster than they could be sent

    int image_bytes = 0;           ///< the newest panorama as JPEG
    int image_budget_bytes = 0;    ///< what the governor of its size aims at
    int image_quality = 0;         ///< JPEG quality of the newest panorama
    int receive_buffer_bytes = 0;  ///< that this system grants a subscriber who asks for more
    EventText warning{};           ///< what a person should put right; empty when all is well

    std::uint64_t rss_bytes = 0;     ///< 0: not known
    std::uint64_t minor_faults = 0;  ///< since the start
    std::uint64_t major_faults = 0;  ///< since the start
    std::int64_t heap_calls = -1;    ///< since the start; below 0 where they cannot be counted

    RecordingHealth recording{};
    HealthList<CameraHealth, 8> cameras{};  ///< in the order of the bits of cameras_missing
    HealthList<StageHealth, 12> stages{};
};

}  // namespace hitchview::hal
