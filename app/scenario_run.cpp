#include "app/scenario_run.hpp"

#include <algorithm>
#include <nlohmann/json.hpp>

#include "algo/offline_unified_vertex_motion.hpp"
#include "algo/unified_vertex_motion.hpp"
#include "app/safety_meter.hpp"
#include "app/scenario_frames.hpp"
#include "app/scenario_meter.hpp"
#include "app/scenario_pictures.hpp"
#include "app/simulated_geometry.hpp"
#include "app/worker_pool.hpp"

namespace hitchview::app {
namespace {

using drivers::SimulatedRig;
using nlohmann::json;

/// Frame sets that the live mode holds back.
int HeldSets(const ScenarioRunOptions& options) {
    return options.offline ? 0 : options.lookahead_frames;
}

algo::UnifiedVertexMotionOptions MotionOptions(const ScenarioRunOptions& options) {
    algo::UnifiedVertexMotionOptions motion;
    motion.lookahead_frames = HeldSets(options);
    return motion;
}

json StageJson(const AllStageTimes& times) {
    json stages;
    for (int i = 0; i < kStages; ++i) {
        stages[std::string(ToString(static_cast<Stage>(i)))] =
            times[static_cast<std::size_t>(i)].Summarise().p50_ms;
    }
    return stages;
}

/// The estimation of a drive.
struct Motion {
    std::unique_ptr<algo::VertexMotion> any;
    algo::OfflineUnifiedVertexMotion* offline = nullptr;  ///< the same, if it needs a first pass
};

Motion MakeMotion(const RigGeometry& geometry, const ScenarioRunOptions& options) {
    const algo::UnifiedVertexMotionOptions motion = MotionOptions(options);
    if (!options.offline) {
        return {
            std::make_unique<algo::UnifiedVertexMotion>(geometry.canvas, geometry.units, motion)};
    }
    auto offline = std::make_unique<algo::OfflineUnifiedVertexMotion>(
        geometry.canvas, geometry.units, algo::OfflineOptions{.motion = motion});
    algo::OfflineUnifiedVertexMotion* const first_pass = offline.get();
    return {std::move(offline), first_pass};
}

/// One rig, one pipeline and what looks at it.
class Drive {
 public:
    Drive(const SimulatedRig& rig, const RigGeometry& geometry, const ScenarioRunOptions& options,
          const std::filesystem::path& cache, ScenarioPictures& pictures)
        : frames_to_show_(
              std::min(options.frames.value_or(rig.options().frames), rig.options().frames)),
          workers_(options.workers),
          frames_(rig, HeldSets(options) + 2, cache, workers_),
          motion_(MakeMotion(geometry, options)),
          pipeline_(geometry, *motion_.any, workers_),
          safety_(rig, geometry),
          pictures_(pictures) {
        if (!options.safety_alone) meter_.emplace(rig, geometry);
    }

    json Run(const std::atomic<bool>& stop) {
        Prime();
        Learn(stop);
        for (int frame = 0; frame < frames_to_show_ && !stop; ++frame)
            Look(pipeline_.Process(frames_.Take(frame)));
        while (const ShownPanorama* shown = pipeline_.Flush()) Look(shown);
        json figures = meter_ ? meter_->Figures() : json();
        figures["safety"] = safety_.Figures();
        figures["stage_p50_ms"] = StageJson(pipeline_.times());
        pipeline_.Start();  // gives the last leases back while the pools live
        return figures;
    }

 private:
    void Prime() {
        const int sets = std::min(ScenarioFrames::kBatch, frames_to_show_);
        for (int i = 0; i < sets && !pipeline_.Prime(frames_.Peek(i)); ++i) {
        }
        pipeline_.Start();
    }

    /// The first pass of the offline form.
    void Learn(const std::atomic<bool>& stop) {
        if (motion_.offline == nullptr) return;
        for (int frame = 0; frame < frames_to_show_ && !stop; ++frame)
            motion_.offline->Learn(Borrow(frames_.Take(frame)), workers_);
        motion_.offline->Solve();
        frames_.Rewind();
    }

    void Look(const ShownPanorama* shown) {
        if (shown == nullptr) return;
        safety_.Observe(*shown, pipeline_.map(), pipeline_.shown_pictures());
        pictures_.OfferPanorama(*shown);
        if (meter_) Measure(*shown);
    }

    void Measure(const ShownPanorama& shown) {
        meter_->Observe(shown, pipeline_.map());
        const int frame = static_cast<int>(shown.picture.header.sequence);
        for (const algo::Overlap overlap : algo::kOverlaps) {
            if (const auto error_px = meter_->StripError_px(frame, overlap))
                pictures_.OfferSeam(overlap, *error_px, shown, pipeline_);
        }
    }

    int frames_to_show_;
    WorkerPool workers_;
    ScenarioFrames frames_;
    Motion motion_;
    Pipeline pipeline_;
    SafetyMeter safety_;
    std::optional<ScenarioMeter> meter_;
    ScenarioPictures& pictures_;
};

}  // namespace

std::string DriveName(const std::string& scenario, const ScenarioRunOptions& options) {
    std::string name = scenario;
    if (options.offline) {
        name += "+all";
    } else if (options.lookahead_frames > 0) {
        name += '+';
        name += std::to_string(options.lookahead_frames);
    }
    return name;
}

hal::Checked<json> RunScenario(const std::string& name,
                               const drivers::SimulationOptions& simulation,
                               const ScenarioRunOptions& options, const std::atomic<bool>& stop) {
    const auto rig = SimulatedRig::Create(simulation);
    if (!rig) return name + ": " + rig.error();
    const auto geometry = GeometryOf(*rig.value(), options.canvas_width_px);
    if (!geometry) return name + ": " + geometry.error();
    const std::filesystem::path cache = options.cache.empty()
                                            ? options.cache
                                            : options.cache / (name + "-" + CacheKey(*rig.value()));
    ScenarioPictures pictures(DriveName(name, options), options.out,
                              options.frames.value_or(rig.value()->options().frames));
    json figures = Drive(*rig.value(), geometry.value(), options, cache, pictures).Run(stop);
    figures["offline"] = options.offline;
    figures["lookahead_frames"] = options.offline ? json() : json(options.lookahead_frames);
    if (const std::string refused = pictures.Write(); !refused.empty()) return refused;
    return figures;
}

}  // namespace hitchview::app
