#include "app/bench_verb.hpp"

#include <cstdio>
#include <map>
#include <nlohmann/json.hpp>

#include "app/bench_baselines.hpp"
#include "app/bench_memory.hpp"
#include "app/bench_run.hpp"
#include "app/bench_table.hpp"
#include "app/config.hpp"
#include "app/evaluation_statistics.hpp"
#include "app/exit_code.hpp"
#include "app/report.hpp"
#include "app/scenario_frames.hpp"
#include "app/simulated_geometry.hpp"
#include "app/worker_pool.hpp"
#include "drivers/simulated_scenario.hpp"

namespace hitchview::app {
namespace {

using drivers::SimulatedRig;
using nlohmann::json;

constexpr int kStopped = 1;
constexpr int kScalingFrames = 40;
/// In a run without lookahead: one is worked on, one waits, and four are being filled.
constexpr int kHeldSets = 6;

drivers::SimulationOptions Simulation(int camera_width_px) {
    drivers::SimulationOptions simulation = drivers::FindScenario("straight")->options;
    simulation.width_px = camera_width_px;
    simulation.height_px = camera_width_px * 9 / 16;
    simulation.frames = BenchFrames::kSets;
    simulation.render_threads = 1;
    return simulation;
}

using Rounds = std::map<std::string, std::vector<double>>;

void AddRecording(const BenchFigures& figures, Rounds& rounds) {
    std::uint64_t recorded = 0;
    for (const FrameCounts& camera : figures.recording->cameras) recorded += camera.recorded;
    rounds["recording_p50_ms"].push_back(figures.recorded.p50_ms);
    rounds["recording_p99_ms"].push_back(figures.recorded.p99_ms);
    rounds["recording_dropped"].push_back(figures.recorded.dropped);
    rounds["recording_deadline_misses"].push_back(figures.recorded.deadline_misses);
    rounds["recorded_frames"].push_back(static_cast<double>(recorded));
    rounds["recorded_bytes"].push_back(static_cast<double>(figures.recording->written.bytes));
    rounds["unrecorded_frames"].push_back(static_cast<double>(figures.recording->dropped));
}

/// One simulated rig and all that is measured with it.
class Bench {
 public:
    Bench(const SimulatedRig& rig, const BenchOptions& options)
        : rig_(rig), options_(options), cache_(CacheOf(rig, options)) {}

    json WholeFrame() {
        BenchFrames frames = Frames(SimulatedRig::kCameras);
        const RigGeometry geometry = Geometry(options_.canvas_width_px, SimulatedRig::kCameras);
        const int width = geometry.canvas.width_px;
        const int height = geometry.canvas.height_px;
        const std::size_t panorama_bytes =
            hal::FrameBytes({width, height, hal::PixelFormat::kI420, hal::Range::kFull});
        const BenchRunOptions run{options_.workers, options_.frames, kDefaultPeriod,
                                  options_.record};
        Rounds rounds;
        for (int i = 0; i < (options_.quick ? 1 : options_.rounds); ++i) {
            const double memcpy_ms = MemcpyMs(frames, panorama_bytes);
            const BenchFigures figures = RunBench(geometry, frames, run);
            rounds["core_ms_without_jpeg"].push_back(figures.core_ms);
            rounds["jpeg_ms"].push_back(figures.jpeg_ms);
            rounds["jpeg_bytes"].push_back(figures.jpeg_bytes);
            rounds["growth"].push_back(figures.growth);
            rounds["interval_ms"].push_back(figures.interval_ms);
            rounds["p50_ms"].push_back(figures.paced.p50_ms);
            rounds["p99_ms"].push_back(figures.paced.p99_ms);
            rounds["dropped"].push_back(figures.paced.dropped);
            rounds["deadline_misses"].push_back(figures.paced.deadline_misses);
            if (figures.recording) AddRecording(figures, rounds);
            rounds["memcpy_ms"].push_back(memcpy_ms);
            rounds["memcpy_ratio"].push_back(figures.core_ms / memcpy_ms);
        }
        json whole;
        for (const auto& [name, values] : rounds) whole[name] = Quantile(values, 0.5).value();
        whole["memcpy_bytes"] = frames.BytesPerSet() + panorama_bytes;
        return whole;
    }

    /// On one thread, where wall time is CPU time. Adds what is known of rendering to `whole`.
    json Stages(json& whole) {
        BenchFrames frames = Frames(SimulatedRig::kCameras);
        const RigGeometry geometry = Geometry(options_.canvas_width_px, SimulatedRig::kCameras);
        const BenchFigures figures = RunBench(geometry, frames, {1, options_.frames, {}});
        const double memcpy_ms = whole.at("memcpy_ms").get<double>();
        json stages;
        for (int i = 0; i < kStages; ++i) {
            const auto summary = figures.times[static_cast<std::size_t>(i)].Summarise();
            stages[std::string(ToString(static_cast<Stage>(i)))] = {
                {"p50_ms", summary.p50_ms},
                {"p99_ms", summary.p99_ms},
                {"memcpy_ratio", summary.p50_ms / memcpy_ms}};
        }
        whole["remap_ms"] = RemapMs(options_.camera_width_px, options_.camera_width_px * 9 / 16,
                                    geometry.canvas.width_px, geometry.canvas.height_px);
        whole["render_to_remap_ratio"] =
            stages["render"]["p50_ms"].get<double>() / whole["remap_ms"].get<double>();
        return stages;
    }

    /// Bytes.
    json Memory() const {
        hal::FrameFormat frame = rig_.format();
        frame.pixel_format = options_.format;
        json parts;
        std::size_t sum = 0;
        for (const MemoryPart& part : MemoryOf(
                 Geometry(options_.canvas_width_px, SimulatedRig::kCameras), frame, kHeldSets)) {
            parts[part.name] = part.bytes;
            sum += part.bytes;
        }
        parts["all"] = sum;
        return parts;
    }

    json Scaling(const std::atomic<bool>& stop) {
        json rows = json::array();
        for (int cameras = 1; cameras <= SimulatedRig::kCameras && !stop; ++cameras)
            rows.push_back(ScalingRow(cameras, options_.canvas_width_px, options_.workers));
        for (const int width : {1024, 2048, 4096}) {
            if (!stop && width != options_.canvas_width_px)
                rows.push_back(ScalingRow(SimulatedRig::kCameras, width, options_.workers));
        }
        for (int workers = 1; workers <= options_.workers && !stop; ++workers) {
            if (workers != options_.workers)
                rows.push_back(
                    ScalingRow(SimulatedRig::kCameras, options_.canvas_width_px, workers));
        }
        return rows;
    }

 private:
    static std::filesystem::path CacheOf(const SimulatedRig& rig, const BenchOptions& options) {
        return options.cache.empty() ? options.cache : options.cache / ("bench-" + CacheKey(rig));
    }

    BenchFrames Frames(int cameras) {
        WorkerPool workers(options_.workers);
        return {rig_, cameras, options_.format, cache_, workers};
    }
    RigGeometry Geometry(int canvas_width_px, int cameras) const {
        auto geometry = GeometryOf(rig_, canvas_width_px, cameras);
        HV_EXPECT(geometry.ok());  // the widths that can be asked for are valid
        return std::move(geometry.value());
    }

    json ScalingRow(int cameras, int canvas_width_px, int workers) {
        BenchFrames frames = Frames(cameras);
        const BenchFigures figures =
            RunBench(Geometry(canvas_width_px, cameras), frames, {workers, kScalingFrames, {}});
        return {{"cameras", cameras},         {"canvas_width_px", canvas_width_px},
                {"workers", workers},         {"core_ms_without_jpeg", figures.core_ms},
                {"jpeg_ms", figures.jpeg_ms}, {"interval_ms", figures.interval_ms}};
    }

    const SimulatedRig& rig_;
    BenchOptions options_;
    std::filesystem::path cache_;
};

}  // namespace

int BenchVerb(const BenchOptions& options, const std::atomic<bool>& stop) {
    const auto rig = SimulatedRig::Create(Simulation(options.camera_width_px));
    if (!rig) return Fail(kMachineFailed, rig.error());
    Bench bench(*rig.value(), options);
    json figures;
    figures["whole_frame"] = bench.WholeFrame();
    if (stop) return kStopped;
    figures["stages"] = bench.Stages(figures["whole_frame"]);
    figures["memory_bytes"] = bench.Memory();
    figures["scaling"] = options.quick ? json::array() : bench.Scaling(stop);
    if (stop) return kStopped;
    std::fputs(BenchTable(figures).c_str(), stdout);
    if (options.json.empty()) return 0;
    const std::string refused = WriteJson(figures, options.json);
    return refused.empty() ? 0 : Fail(kMachineFailed, refused);
}

}  // namespace hitchview::app
