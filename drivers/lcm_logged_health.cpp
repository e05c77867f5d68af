#include "drivers/lcm_logged_health.hpp"

#include <cmath>

#include "drivers/lcm_message_bounds.hpp"
#include "drivers/lcm_message_reader.hpp"
#include "lcmtypes/hitchview_health_t.h"

namespace hitchview::drivers {
namespace {

using hal::Error;
using hal::Instant;
using hal::Result;

std::string_view TakeShortText(LcmMessageReader& reader, bool& sound) {
    const std::string_view text = reader.TakeString();
    sound = sound && text.size() <= kMostHealthTextBytes;
    return text;
}

LoggedCameraHealth TakeCamera(LcmMessageReader& reader, bool& sound) {
    LoggedCameraHealth camera;
    camera.name = TakeShortText(reader, sound);
    camera.unit = TakeShortText(reader, sound);
    camera.shown = reader.Take<std::int8_t>() != 0;
    camera.state = reader.Take<std::int8_t>();
    camera.frames_per_s = reader.TakeDouble();
    camera.age_ms = reader.TakeDouble();
    camera.delivered = reader.Take<std::int64_t>();
    camera.lost = reader.Take<std::int64_t>();
    camera.corrupted = reader.Take<std::int64_t>();
    camera.reopened = reader.Take<std::int64_t>();
    sound = sound && std::isfinite(camera.frames_per_s) && camera.frames_per_s >= 0;
    return camera;
}

LoggedStageTime TakeStage(LcmMessageReader& reader, bool& sound) {
    LoggedStageTime stage;
    stage.name = TakeShortText(reader, sound);
    for (double* time_ms : {&stage.last_ms, &stage.p50_ms, &stage.p99_ms, &stage.max_ms}) {
        *time_ms = reader.TakeDouble();
    }
    return stage;
}

/// As many as the count before them says, none if that is outside [0, most].
template <typename Value>
void TakeList(LcmMessageReader& reader, int most, std::vector<Value>& values, bool& sound,
              Value (*take)(LcmMessageReader&, bool&)) {
    const auto count = reader.Take<std::int32_t>();
    sound = sound && reader.ok() && count >= 0 && count <= most;
    if (!sound) return;
    values.reserve(static_cast<std::size_t>(count));
    for (int i = 0; i < count && reader.ok(); ++i) values.push_back(take(reader, sound));
}

void TakePanoramas(LcmMessageReader& reader, LoggedHealth& health, bool& sound) {
    health.version = TakeShortText(reader, sound);
    health.calibration_id = TakeShortText(reader, sound);
    health.uptime_s = reader.TakeDouble();
    health.panoramas_per_s = reader.TakeDouble();
    health.panoramas = reader.Take<std::int64_t>();
    health.dropped = reader.Take<std::int64_t>();
    health.deadline_misses = reader.Take<std::int64_t>();
    health.events_lost = reader.Take<std::int64_t>();
    sound = sound && std::isfinite(health.uptime_s) && std::isfinite(health.panoramas_per_s);
}

void TakeImageSize(LcmMessageReader& reader, LoggedHealth& health, bool& sound) {
    health.image_bytes = reader.Take<std::int32_t>();
    health.image_budget_bytes = reader.Take<std::int32_t>();
    health.image_quality = reader.Take<std::int32_t>();
    health.receive_buffer_bytes = reader.Take<std::int32_t>();
    health.warning = TakeShortText(reader, sound);
}

void TakeMachine(LcmMessageReader& reader, LoggedHealth& health, bool& sound) {
    health.rss_bytes = reader.Take<std::int64_t>();
    health.minor_faults = reader.Take<std::int64_t>();
    health.major_faults = reader.Take<std::int64_t>();
    health.heap_calls = reader.Take<std::int64_t>();
    health.recording = reader.Take<std::int8_t>();
    health.recorded_bytes = reader.Take<std::int64_t>();
    health.recording_dropped = reader.Take<std::int64_t>();
    health.disk_free_bytes = reader.Take<std::int64_t>();
    sound = sound && health.recording >= HITCHVIEW_HEALTH_T_RECORDING_OFF &&
            health.recording <= HITCHVIEW_HEALTH_T_RECORDING_STOPPED;
}

}  // namespace

Result<LoggedHealth> ParseLoggedHealth(std::span<const std::uint8_t> message) {
    LcmMessageReader reader(message);
    if (reader.Take<std::int64_t>() != __hitchview_health_t_get_hash()) return Error::kCorrupted;
    LoggedHealth health;
    bool sound = true;
    health.sequence = reader.Take<std::uint32_t>();
    health.utime_us = reader.Take<std::int64_t>();
    health.monotonic = Instant(reader.Take<std::int64_t>());
    TakePanoramas(reader, health, sound);
    TakeImageSize(reader, health, sound);
    TakeMachine(reader, health, sound);
    TakeList(reader, kMostHealthCameras, health.cameras, sound, TakeCamera);
    TakeList(reader, kMostHealthStages, health.stages, sound, TakeStage);
    sound = sound && reader.at_end() && IsEpoch(health.utime_us) && IsInstant(health.monotonic);
    if (!sound) return Error::kCorrupted;
    return health;
}

}  // namespace hitchview::drivers
