#include "app/log_report.hpp"

#include <nlohmann/json.hpp>

#include "app/log_time.hpp"
#include "hal/hitch_angle.hpp"

namespace hitchview::app {
namespace {

using nlohmann::json;

json OrNull(const std::optional<double>& known) {
    return known ? json(*known) : json();
}

json Sequence(const SequenceFigures& figures) {
    return {{"messages", figures.messages},
            {"lost", figures.lost},
            {"gaps", figures.gaps},
            {"resets", figures.resets}};
}

json Cameras(const std::vector<CameraFigures>& cameras) {
    json all = json::object();
    for (const CameraFigures& camera : cameras) {
        json& one = all[camera.channel] = Sequence(camera.frames);
        one["time_gaps"] = camera.time_gaps;
        one["longest_gap_ms"] = OrNull(camera.longest_gap_ms);
        one["period_ms"] = OrNull(camera.period_ms);
        one["drift_ppm"] = OrNull(camera.drift_ppm);
    }
    return all;
}

json HitchAngle(const HitchAngleFigures& figures) {
    json report = Sequence(figures.messages);
    report["least_rad"] = OrNull(figures.least_rad);
    report["most_rad"] = OrNull(figures.most_rad);
    report["qualities"] = {{"valid", figures.qualities[0]},
                           {"not_available", figures.qualities[1]},
                           {"error", figures.qualities[2]},
                           {"implausible", figures.qualities[3]},
                           {"stale", figures.qualities[4]}};
    return report;
}

json Damage(const drivers::LcmLogDamage& damage) {
    return {{"skipped_bytes", damage.skipped_bytes},
            {"places", damage.places},
            {"torn_bytes", damage.torn_bytes},
            {"lost_events", damage.lost_events}};
}

json Panoramas(const PanoramaFigures& figures) {
    return {{"images", Sequence(figures.images)},
            {"status", Sequence(figures.status)},
            {"deadline_misses", figures.deadline_misses},
            {"dropped", figures.dropped}};
}

json Clock(const ClockFigures& figures) {
    return {{"readings", figures.readings},
            {"steps", figures.steps},
            {"largest_step_ms", OrNull(figures.largest_step_ms)},
            {"log_steps_back", figures.log_steps_back}};
}

json Events(const std::vector<ListedEvent>& events) {
    json list = json::array();
    for (const ListedEvent& event : events)
        list.push_back({{"time", UtcText(event.utime_us)},
                        {"utime_us", event.utime_us},
                        {"code", event.code},
                        {"subject", event.subject},
                        {"text", event.text}});
    return list;
}

json Recording(const LogFigures& figures) {
    return {{"segments", figures.segments},
            {"bytes", figures.bytes},
            {"events", figures.events},
            {"first", UtcText(figures.first_us)},
            {"first_utime_us", figures.first_us},
            {"last_utime_us", figures.last_us},
            {"duration_s", figures.Duration_s()},
            {"channels", figures.channels},
            {"undecodable", figures.undecodable},
            {"rig", figures.has_rig},
            {"calibration_id", figures.calibration_id},
            {"period_ms", figures.period_ms > 0 ? json(figures.period_ms) : json()}};
}

}  // namespace

json LogReport(const LogFigures& figures, const LogVerdict& verdict) {
    json report = Recording(figures);
    report["verdict"] = verdict.good() ? "good" : "bad";
    report["reasons"] = verdict.reasons;
    report["notes"] = verdict.notes;
    report["cameras"] = Cameras(figures.cameras);
    report["sets"] = {{"sets", figures.sets.sets},
                      {"complete", figures.sets.complete},
                      {"spread_p50_ms", OrNull(figures.sets.p50_ms)},
                      {"spread_p99_ms", OrNull(figures.sets.p99_ms)},
                      {"spread_max_ms", OrNull(figures.sets.max_ms)}};
    report["can"] = {{"frames", figures.can.frames},
                     {"errors", figures.can.errors},
                     {"gaps", figures.can.gaps},
                     {"longest_gap_ms", OrNull(figures.can.longest_gap_ms)}};
    report["hitch_angle"] = HitchAngle(figures.hitch_angle);
    report["articulation_minus_hitch_angle"] = {
        {"compared", figures.articulation.compared},
        {"median_rad", OrNull(figures.articulation.median_rad)},
        {"median_abs_rad", OrNull(figures.articulation.median_abs_rad)},
        {"max_abs_rad", OrNull(figures.articulation.max_abs_rad)}};
    report["panoramas"] = Panoramas(figures.panoramas);
    report["clock"] = Clock(figures.clock);
    report["damage"] = Damage(figures.damage);
    report["listed_events"] = Events(figures.listed_events);
    report["event_messages"] = Sequence(figures.event_messages);
    return report;
}

}  // namespace hitchview::app
