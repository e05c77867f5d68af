#include "app/report.hpp"

#include <cmath>
#include <fstream>
#include <iomanip>
#include <nlohmann/json.hpp>
#include <sstream>
#include <string_view>
#include <vector>

#include "app/evaluation_statistics.hpp"

namespace hitchview::app {
namespace {

using nlohmann::json;

struct NamedTimes {
    std::string_view name;
    const StageTimes* times;
};

/// In the order of a panorama's way.
std::vector<NamedTimes> AllTimes(const RunSummary& run) {
    std::vector<NamedTimes> all;
    for (int i = 0; i < kStages; ++i)
        all.push_back({ToString(static_cast<Stage>(i)), &run.times[static_cast<std::size_t>(i)]});
    all.push_back({"jpeg", &run.publishing.jpeg});
    all.push_back({"publish", &run.publishing.send});
    all.push_back({"latency", &run.publishing.latency});
    return all;
}

template <typename T>
json OrNull(const std::optional<T>& known) {
    return known ? json(*known) : json();
}

json HeapCallsByThread(const MemorySummary& memory) {
    if (!memory.heap_calls) return nullptr;
    json threads = json::object();
    for (const auto& [name, calls] : memory.heap_calls->threads) {
        json& sum = threads[name];
        sum = (sum.is_null() ? 0 : sum.get<std::uint64_t>()) + calls;
    }
    return threads;
}

/// Figures since READY, beside the rest of the report.
void AddMemory(const MemorySummary& memory, json& report) {
    const auto& calls = memory.heap_calls;
    report["heap_calls_after_ready"] = calls ? json(calls->frame_path) : json();
    report["heap_calls_by_thread"] = HeapCallsByThread(memory);
    report["heap_calls_files"] = calls ? json(calls->files) : json();
    report["rss_bytes_at_ready"] = OrNull(memory.at_ready.rss_bytes);
    report["rss_bytes"] = OrNull(memory.at_end.rss_bytes);
    report["minor_faults_after_ready"] = memory.at_end.minor_faults - memory.at_ready.minor_faults;
    report["major_faults_after_ready"] = memory.at_end.major_faults - memory.at_ready.major_faults;
}

json StageJson(const StageTimes& times) {
    if (times.empty()) return {{"p50_ms", nullptr}, {"p99_ms", nullptr}, {"max_ms", nullptr}};
    const StageTimes::Summary s = times.Summarise();
    return {{"p50_ms", s.p50_ms}, {"p99_ms", s.p99_ms}, {"max_ms", s.max_ms}};
}

json Stages(const RunSummary& run) {
    json stages;
    for (const NamedTimes& stage : AllTimes(run))
        stages[std::string(stage.name)] = StageJson(*stage.times);
    return stages;
}

json Pools(const RunSummary& run) {
    json pools = json::object();
    for (const auto& [name, level] : run.pools) {
        if (level.slots == 0) continue;
        pools[name] = {{"slots", level.slots}, {"low_water", level.low_water}};
    }
    return pools;
}

json EmptyUnit() {
    return {{"cropping_mean", nullptr},
            {"cropping_min", nullptr},
            {"distortion_min", nullptr},
            {"stability", nullptr},
            {"jitter_ratio", nullptr}};
}

/// Takes over what is known; null does not overwrite a figure.
void FillIn(const json& known, json& report) {
    if (!known.is_object()) return;
    for (const auto& [key, value] : known.items()) {
        if (value.is_object()) {
            FillIn(value, report[key]);
        } else if (!value.is_null() && key != "frames") {
            report[key] = value;
        } else if (!report.contains(key)) {
            report[key] = nullptr;
        }
    }
}

json EmptySeam() {
    return {{"median_px", nullptr}, {"p95_px", nullptr}, {"worst_frame_px", nullptr}};
}

/// Deviation of the camera's clock from the middle one of the rig.
json Drift(const LiveCameraSummary& camera, const std::optional<double>& middle_ms) {
    if (!camera.period_ms || !middle_ms) return nullptr;
    return 1e6 * (*camera.period_ms / *middle_ms - 1);
}

std::optional<double> MiddlePeriod(const LiveSummary& live) {
    std::vector<double> periods;
    for (const LiveCameraSummary& camera : live.cameras) {
        if (camera.period_ms) periods.push_back(*camera.period_ms);
    }
    return Quantile(periods, 0.5);
}

json LiveCameras(const LiveSummary& live) {
    const std::optional<double> middle_ms = MiddlePeriod(live);
    json cameras = json::object();
    for (const LiveCameraSummary& camera : live.cameras) {
        cameras[camera.name] = {{"delivered", camera.device.delivered},
                                {"lost", camera.device.lost},
                                {"lost_unnumbered", camera.device.lost_unnumbered},
                                {"corrupted", camera.device.corrupted},
                                {"reopened", camera.device.reopened},
                                {"taken", camera.inbox.taken},
                                {"superseded", camera.inbox.superseded},
                                {"set_aside", camera.inbox.set_aside},
                                {"pending", camera.inbox.pending},
                                {"period_ms", OrNull(camera.period_ms)},
                                {"drift_ppm", Drift(camera, middle_ms)}};
    }
    return cameras;
}

/// Null for recordings and simulations.
json Live(const RunSummary& run) {
    if (!run.live) return nullptr;
    const SetCounts& sets = run.live->sets;
    return {{"sets",
             {{"complete", sets.complete},
              {"partial", sets.partial},
              {"empty", sets.empty},
              {"skipped", sets.skipped}}},
            {"spread", StageJson(run.live->spread)},
            {"cameras", LiveCameras(*run.live)}};
}

json Events(const EventCounts& counts) {
    json events{{"refused", counts.refused}};
    for (std::size_t i = 0; i < hal::kEventCodes.size(); ++i)
        events[ToString(hal::kEventCodes[i])] = counts.happened[i];
    return events;
}

/// Null for a rig that cannot tell it.
json Articulation(const RunSummary& run) {
    if (!run.ring || run.cameras[algo::Unit::kTrailer] == 0 || run.frames == 0) return nullptr;
    const ArticulationSummary& a = run.articulation;
    const auto frames = static_cast<double>(a.frames);
    json report{{"known_share", frames / static_cast<double>(run.frames)},
                {"least_rad", nullptr},
                {"most_rad", nullptr},
                {"sigma_rad", nullptr}};
    if (a.frames == 0) return report;
    report["least_rad"] = a.least_rad;
    report["most_rad"] = a.most_rad;
    report["sigma_rad"] = std::sqrt(a.variances / frames);
    return report;
}

/// Null where no bus was read.
json Can(const std::optional<CanSummary>& can) {
    if (!can) return nullptr;
    return {{"frames", can->frames},
            {"angles", can->angles},
            {"angles_refused", can->angles_refused},
            {"dropped", can->dropped},
            {"errors", can->errors},
            {"disconnections", can->disconnections}};
}

/// Null where nothing was recorded.
json Recording(const std::optional<RecordingSummary>& recording) {
    if (!recording) return nullptr;
    json cameras = json::object();
    for (const FrameCounts& camera : recording->cameras)
        cameras[camera.name] = {{"recorded", camera.recorded}, {"dropped", camera.dropped}};
    return {{"files", recording->written.files},
            {"bytes", recording->written.bytes},
            {"events", recording->written.events},
            {"dropped", recording->dropped},
            {"memory_bytes", recording->memory_bytes},
            {"most_used_bytes", recording->most_used_bytes},
            {"cameras", cameras}};
}

}  // namespace

json MakeReport(const RunSummary& run, const json& quality) {
    json report{
        {"schema", 1},
        {"frames", run.frames},
        {"dropped", run.dropped},
        {"lightened", run.lightened},
        {"period_ms", run.period_ms},
        {"frames_per_second",
         run.duration_s > 0 ? json(static_cast<double>(run.frames) / run.duration_s) : json()},
        {"stages", Stages(run)},
        {"deadline_misses", run.deadline_misses},
        {"calibration_id", run.calibration_id.empty() ? json() : json(run.calibration_id)}};
    AddMemory(run.memory, report);
    report["pools"] = Pools(run);
    report["live"] = Live(run);
    report["events"] = Events(run.events);
    for (const algo::Unit unit : algo::kUnits) {
        if (run.cameras[unit] > 0) report["units"][ToString(unit)] = EmptyUnit();
    }
    for (const algo::Overlap overlap : algo::kOverlaps) {
        const bool exists =
            run.cameras[algo::Unit::kTrailer] > 0 && (run.ring || overlap == algo::Overlap::kRight);
        if (!exists) continue;
        json& seam = report["seams"][ToString(overlap)];
        seam = EmptySeam();
        seam["locked_share"] = run.frames > 0
                                   ? json(static_cast<double>(run.locked_frames[overlap]) /
                                          static_cast<double>(run.frames))
                                   : json();
    }
    report["articulation"] = Articulation(run);
    report["can"] = Can(run.can);
    report["recording"] = Recording(run.recording);
    FillIn(quality, report);
    return report;
}

std::string WriteJson(const json& json, const std::filesystem::path& file) {
    std::ofstream out(file);
    out << json.dump(2) << '\n';
    out.close();
    return out ? "" : file.string() + ": cannot be written";
}

std::string Table(const RunSummary& run) {
    std::ostringstream text;
    text << std::fixed << std::setprecision(1);
    text << run.frames << " panoramas in " << run.duration_s << " s";
    if (run.duration_s > 0)
        text << " (" << static_cast<double>(run.frames) / run.duration_s << " fps)";
    text << ", " << run.dropped << " dropped, " << run.deadline_misses
         << " longer than a period of " << run.period_ms << " ms\n"
         << std::setprecision(2) << "  stage      p50 ms   p99 ms   max ms\n";
    for (const NamedTimes& stage : AllTimes(run)) {
        if (stage.times->empty()) continue;
        const StageTimes::Summary s = stage.times->Summarise();
        text << "  " << std::left << std::setw(8) << stage.name << std::right << std::setw(9)
             << s.p50_ms << std::setw(9) << s.p99_ms << std::setw(9) << s.max_ms << '\n';
    }
    return text.str();
}

}  // namespace hitchview::app
