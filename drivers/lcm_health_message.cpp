#include "drivers/lcm_health_message.hpp"

#include <algorithm>

namespace hitchview::drivers {
namespace {

using State = hal::RecordingState;
static_assert(int(State::kOff) == HITCHVIEW_HEALTH_T_RECORDING_OFF);
static_assert(int(State::kArmed) == HITCHVIEW_HEALTH_T_RECORDING_ARMED);
static_assert(int(State::kOn) == HITCHVIEW_HEALTH_T_RECORDING_ON);
static_assert(int(State::kStopped) == HITCHVIEW_HEALTH_T_RECORDING_STOPPED);

using Camera = hal::CameraState;
static_assert(int(Camera::kGood) == HITCHVIEW_CAMERA_HEALTH_T_GOOD);
static_assert(int(Camera::kLost) == HITCHVIEW_CAMERA_HEALTH_T_LOST);
static_assert(int(Camera::kLate) == HITCHVIEW_CAMERA_HEALTH_T_LATE);
static_assert(int(Camera::kDisordered) == HITCHVIEW_CAMERA_HEALTH_T_DISORDERED);
static_assert(int(Camera::kBlack) == HITCHVIEW_CAMERA_HEALTH_T_BLACK);
static_assert(int(Camera::kBlinded) == HITCHVIEW_CAMERA_HEALTH_T_BLINDED);
static_assert(int(Camera::kFrozen) == HITCHVIEW_CAMERA_HEALTH_T_FROZEN);
static_assert(int(Camera::kStuck) == HITCHVIEW_CAMERA_HEALTH_T_STUCK);
static_assert(int(Camera::kBlurred) == HITCHVIEW_CAMERA_HEALTH_T_BLURRED);
static_assert(int(Camera::kDirty) == HITCHVIEW_CAMERA_HEALTH_T_DIRTY);

/// The generated types have no const members; encoding only reads them.
template <typename Text>
char* Borrow(const Text& text) {
    return const_cast<char*>(text.c_str());
}

std::int64_t Signed(std::uint64_t count) {
    return static_cast<std::int64_t>(count);
}

hitchview_camera_health_t ToMessage(const hal::CameraHealth& camera) {
    return {.name = Borrow(camera.name),
            .unit = Borrow(camera.unit),
            .shown = static_cast<std::int8_t>(camera.shown),
            .state = static_cast<std::int8_t>(camera.state),
            .frames_per_s = camera.frames_per_s,
            .age_ms = camera.age_ms,
            .delivered = Signed(camera.delivered),
            .lost = Signed(camera.lost),
            .corrupted = Signed(camera.corrupted),
            .reopened = Signed(camera.reopened)};
}

hitchview_stage_time_t ToMessage(const hal::StageHealth& stage) {
    return {.name = Borrow(stage.name),
            .last_ms = stage.last_ms,
            .p50_ms = stage.p50_ms,
            .p99_ms = stage.p99_ms,
            .max_ms = stage.max_ms};
}

}  // namespace

LcmHealthMessage::LcmHealthMessage(const hal::Health& health, std::uint32_t sequence,
                                   std::int64_t utime_us) {
    message_.sequence = static_cast<std::int32_t>(sequence);
    message_.utime = utime_us;
    message_.monotonic_ns = health.measured_at.count();
    message_.version = Borrow(health.version);
    message_.calibration_id = Borrow(health.calibration_id);
    AddCounts(health);
    AddMachine(health);
    AddLists(health);
}

void LcmHealthMessage::AddCounts(const hal::Health& health) {
    message_.uptime_s = health.uptime_s;
    message_.panoramas_per_s = health.panoramas_per_s;
    message_.panoramas = Signed(health.panoramas);
    message_.dropped = Signed(health.dropped);
    message_.deadline_misses = Signed(health.deadline_misses);
    message_.events_lost = Signed(health.events_lost);
    message_.image_bytes = health.image_bytes;
    message_.image_budget_bytes = health.image_budget_bytes;
    message_.image_quality = health.image_quality;
}

void LcmHealthMessage::AddMachine(const hal::Health& health) {
    message_.receive_buffer_bytes = health.receive_buffer_bytes;
    message_.warning = Borrow(health.warning);
    message_.rss_bytes = Signed(health.rss_bytes);
    message_.minor_faults = Signed(health.minor_faults);
    message_.major_faults = Signed(health.major_faults);
    message_.heap_calls = health.heap_calls;
    message_.recording = static_cast<std::int8_t>(health.recording.state);
    message_.recorded_bytes = Signed(health.recording.recorded_bytes);
    message_.recording_dropped = Signed(health.recording.dropped);
    message_.disk_free_bytes = health.recording.disk_free_bytes;
}

void LcmHealthMessage::AddLists(const hal::Health& health) {
    std::ranges::transform(health.cameras.items, cameras_.begin(),
                           [](const auto& camera) { return ToMessage(camera); });
    std::ranges::transform(health.stages.items, stages_.begin(),
                           [](const auto& stage) { return ToMessage(stage); });
    message_.ncameras = health.cameras.count;
    message_.cameras = cameras_.data();
    message_.nstages = health.stages.count;
    message_.stages = stages_.data();
}

}  // namespace hitchview::drivers
