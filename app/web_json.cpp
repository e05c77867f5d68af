#include "app/web_json.hpp"

#include <cmath>
#include <nlohmann/json.hpp>
#include <numbers>

namespace hitchview::app {
namespace {

using nlohmann::json;

json StageJson(const drivers::LoggedStageTime& stage) {
    return {{"name", stage.name},
            {"last_ms", Rounded(stage.last_ms)},
            {"p50_ms", Rounded(stage.p50_ms)},
            {"p99_ms", Rounded(stage.p99_ms)},
            {"max_ms", Rounded(stage.max_ms)}};
}

const char* QualityName(hal::HitchAngleQuality quality) {
    switch (quality) {
        case hal::HitchAngleQuality::kValid:
            return "valid";
        case hal::HitchAngleQuality::kNotAvailable:
            return "not available";
        case hal::HitchAngleQuality::kError:
            return "sensor error";
        case hal::HitchAngleQuality::kImplausible:
            return "implausible";
        case hal::HitchAngleQuality::kStale:
            return "stale";
    }
    return "unknown";
}

json Coordinates(const std::vector<float>& values_px) {
    json list = json::array();
    for (const float value : values_px) {
        list.push_back(std::isfinite(value) ? json(std::round(value)) : json());
    }
    return list;
}

}  // namespace

double Rounded(double value) {
    return std::round(value * 100) / 100;
}

double Milliseconds(hal::Instant duration) {
    return Rounded(std::chrono::duration<double, std::milli>(duration).count());
}

double Degrees(double angle_rad) {
    return Rounded(angle_rad * 180 / std::numbers::pi);
}

std::string Line(const json& value) {
    return value.dump(-1, ' ', false, json::error_handler_t::replace);
}

json CameraJson(const WebCamera& camera) {
    json known{{"name", camera.name}, {"unit", camera.unit}};
    if (!camera.has_figures) return known;
    known.update({{"frames_per_s", Rounded(camera.frames_per_s)},
                  {"age_ms", Rounded(camera.age_ms)},
                  {"delivered", camera.delivered},
                  {"lost", camera.lost},
                  {"corrupted", camera.corrupted},
                  {"reopened", camera.reopened},
                  {"condition", camera.condition}});
    return known;
}

json StatusJson(const hal::PanoramaStatus& status) {
    return {{"sequence", status.sequence},
            {"missing", status.cameras_missing},
            {"latency_ms", Milliseconds(status.published_at - status.captured_from)},
            {"total_ms", Rounded(status.total_ms)},
            {"spread_ms", Milliseconds(status.spread)},
            {"seams", {ToString(status.seams[0]), ToString(status.seams[1])}},
            {"seam_matches", status.seam_matches},
            {"unit_features", status.unit_features},
            {"deadline_misses", status.deadline_misses},
            {"dropped", status.dropped},
            {"articulation_deg", Degrees(status.articulation_rad)},
            {"articulation_sigma_deg", Degrees(status.articulation_sigma_rad)}};
}

json HitchAngleJson(const hal::HitchAngle& angle) {
    const bool valid = angle.quality == hal::HitchAngleQuality::kValid;
    return {{"quality", QualityName(angle.quality)},
            {"angle_deg", valid ? json(Degrees(angle.angle_rad)) : json()}};
}

json HealthJson(const drivers::LoggedHealth& health) {
    json stages = json::array();
    for (const auto& stage : health.stages) stages.push_back(StageJson(stage));
    return {{"version", health.version},
            {"calibration_id", health.calibration_id},
            {"uptime_s", std::round(health.uptime_s)},
            {"panoramas_per_s", Rounded(health.panoramas_per_s)},
            {"panoramas", health.panoramas},
            {"dropped", health.dropped},
            {"deadline_misses", health.deadline_misses},
            {"events_lost", health.events_lost},
            {"image_bytes", health.image_bytes},
            {"image_budget_bytes", health.image_budget_bytes},
            {"image_quality", health.image_quality},
            {"receive_buffer_bytes", health.receive_buffer_bytes},
            {"warning", health.warning},
            {"rss_bytes", health.rss_bytes},
            {"major_faults", health.major_faults},
            {"heap_calls", health.heap_calls},
            {"recording", health.recording},
            {"recorded_bytes", health.recorded_bytes},
            {"recording_dropped", health.recording_dropped},
            {"disk_free_bytes", health.disk_free_bytes},
            {"stages", std::move(stages)}};
}

json OverlayJson(const drivers::LoggedOverlay& overlay) {
    return {{"sequence", overlay.sequence},
            {"width", overlay.width_px},
            {"height", overlay.height_px},
            {"mesh_rows", overlay.mesh_rows},
            {"mesh_columns", overlay.mesh_columns},
            {"mesh_x", Coordinates(overlay.mesh_x_px)},
            {"mesh_y", Coordinates(overlay.mesh_y_px)},
            {"seam_y", Coordinates(overlay.seam_y_px)},
            {"left_seam_x", Coordinates(overlay.left_seam_x_px)},
            {"right_seam_x", Coordinates(overlay.right_seam_x_px)}};
}

}  // namespace hitchview::app
