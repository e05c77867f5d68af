#include "app/health_monitor.hpp"

#include "app/heap_calls.hpp"

namespace hitchview::app {
namespace {

using hal::Instant;
using Seconds = std::chrono::duration<double>;

double Rate(std::uint64_t count, std::uint64_t before, double seconds) {
    return seconds > 0 ? static_cast<double>(count - before) / seconds : 0;
}

double Milliseconds(Instant duration) {
    return std::chrono::duration<double, std::milli>(duration).count();
}

}  // namespace

hal::StageHealth StageHealthOf(std::string_view name, const StageTimes& times) {
    const StageTimes::Summary summary = times.Summarise();
    return {.name = name,
            .last_ms = summary.last_ms,
            .p50_ms = summary.p50_ms,
            .p99_ms = summary.p99_ms,
            .max_ms = summary.max_ms};
}

HealthMonitor::HealthMonitor(const HealthOptions& options) : options_(options) {
    for (const WatchedCamera& camera : options.cameras) cameras_.push_back({.camera = camera});
}

void HealthMonitor::Start(Instant now, const Resources& resources) {
    start_ = measured_at_ = now;
    at_start_ = resources;
}

void HealthMonitor::Add(const FrameFigures& figures) {
    newest_ = figures;
    for (std::size_t i = 0; i < cameras_.size(); ++i) {
        CameraState& state = cameras_[i];
        state.shown = (figures.cameras_missing >> i & 1U) == 0;
        state.condition = figures.camera_states[i];
        if (!state.shown) continue;
        ++state.sets;
        state.newest = figures.captured_until;
    }
    for (std::size_t i = 0; i < times_.size(); ++i) {
        times_[i].Add(std::chrono::duration_cast<std::chrono::nanoseconds>(
            std::chrono::duration<float, std::milli>(figures.stage_ms[i])));
    }
}

hal::Health HealthMonitor::Measure(Instant now) {
    const double seconds = Seconds(now - measured_at_).count();
    measured_at_ = now;
    hal::Health health{.measured_at = now,
                       .version = std::string_view(options_.version),
                       .calibration_id = std::string_view(options_.calibration_id),
                       .uptime_s = Seconds(now - start_).count(),
                       .panoramas_per_s = Rate(newest_.panoramas, panoramas_before_, seconds),
                       .panoramas = newest_.panoramas,
                       .dropped = newest_.dropped,
                       .deadline_misses = newest_.deadline_misses};
    panoramas_before_ = newest_.panoramas;
    AddMemory(health);
    if (options_.recorder != nullptr) health.recording = options_.recorder->Level();
    for (CameraState& state : cameras_) health.cameras.Add(Measure(state, now, seconds));
    for (std::size_t i = 0; i < times_.size(); ++i)
        health.stages.Add(StageHealthOf(ToString(static_cast<Stage>(i)), times_[i]));
    return health;
}

hal::CameraHealth HealthMonitor::Measure(CameraState& state, Instant now, double seconds) {
    hal::CameraCounts counts{.delivered = state.sets};
    if (state.camera.device != nullptr) counts = state.camera.device->counts();
    hal::CameraHealth health{
        .name = std::string_view(state.camera.name),
        .unit = std::string_view(algo::ToString(state.camera.unit)),
        .shown = state.shown,
        .state = state.condition,
        .frames_per_s = Rate(counts.delivered, state.before, seconds),
        .age_ms = options_.paced && state.newest ? Milliseconds(now - *state.newest) : -1.0,
        .delivered = counts.delivered,
        .lost = counts.lost,
        .corrupted = counts.corrupted,
        .reopened = counts.reopened};
    state.before = counts.delivered;
    return health;
}

void HealthMonitor::AddMemory(hal::Health& health) const {
    const Resources resources = ReadResources();
    health.rss_bytes = resources.rss_bytes.value_or(0);
    health.minor_faults = resources.minor_faults - at_start_.minor_faults;
    health.major_faults = resources.major_faults - at_start_.major_faults;
    if (const auto calls = HeapCallsOfFramePath())
        health.heap_calls = static_cast<std::int64_t>(*calls);
}

}  // namespace hitchview::app
