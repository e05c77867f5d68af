#include "app/run_loop.hpp"

#include <algorithm>
#include <system_error>

#include "algo/offline_unified_vertex_motion.hpp"
#include "algo/unified_vertex_motion.hpp"
#include "app/board.hpp"
#include "app/frame_synchronizer.hpp"
#include "app/run_outputs.hpp"
#include "app/worker_pool.hpp"

namespace hitchview::app {
namespace {

/// Frame sets that may be looked at to find the trailer before the first one is shown.
constexpr int kPrimeSets = 10;

algo::UnifiedVertexMotionOptions MotionOptions(const RigConfig& config, const RunOptions& options) {
    algo::UnifiedVertexMotionOptions motion;
    motion.stabilize = config.stabilization.enabled;
    motion.stitch = config.stitching.enabled;
    motion.lookahead_frames =
        options.lookahead_frames.value_or(config.stabilization.lookahead_frames);
    motion.border = config.stabilization.border == StabilizationConfig::Border::kCovered
                        ? algo::Border::kCovered
                        : algo::Border::kFree;
    motion.cropping = config.stabilization.cropping;
    motion.smoother = config.stabilization.smoother == StabilizationConfig::Smoother::kPaperWeights
                          ? algo::Smoother::kPaperWeights
                          : algo::Smoother::kRecedingHorizon;
    motion.kappa = config.stitching.kappa;
    if (config.placement) {
        for (const algo::Unit unit : algo::kUnits) {
            const Corner& corner = (*config.placement)[unit];
            if (config.HasUnit(unit))
                motion.placement[unit] = Eigen::Vector2d(corner.x_px, corner.y_px);
        }
    }
    return motion;
}

hal::Checked<std::optional<calib::RigCalibration>> Calibration(const RigConfig& config) {
    if (config.calibration.empty()) return std::optional<calib::RigCalibration>{};
    auto loaded = LoadCalibrationFor(config);
    if (!loaded) return loaded.error();
    return std::optional<calib::RigCalibration>(std::move(*loaded));
}

hal::Checked<hal::Done> MakeFolder(const std::filesystem::path& folder) {
    if (folder.empty()) return hal::Done{};
    std::error_code refused;
    std::filesystem::create_directories(folder, refused);
    if (refused) return folder.string() + ": " + refused.message();
    return hal::Done{};
}

std::string CameraFailure(hal::Error error) {
    return std::string("a camera gives no more frames: ") + hal::ToString(error);
}

/// The estimation of a run.
struct Motion {
    std::unique_ptr<algo::VertexMotion> any;
    algo::OfflineUnifiedVertexMotion* offline = nullptr;  ///< the same, if it needs a first pass
};

Motion MakeMotion(const RigGeometry& rig, const algo::UnifiedVertexMotionOptions& motion,
                  const RunOptions& options) {
    if (!options.offline)
        return {std::make_unique<algo::UnifiedVertexMotion>(rig.canvas, rig.units, motion)};
    auto offline = std::make_unique<algo::OfflineUnifiedVertexMotion>(
        rig.canvas, rig.units,
        algo::OfflineOptions{.motion = motion, .coupling = options.coupling});
    algo::OfflineUnifiedVertexMotion* const first_pass = offline.get();
    return {std::move(offline), first_pass};
}

/// Looks at the first frame sets; the cameras are used up by that.
hal::Checked<hal::Done> Prime(Board& board, Pipeline& pipeline) {
    FrameSynchronizer synchronizer(board.cameras());
    for (int i = 0; i < kPrimeSets; ++i) {
        const auto set = synchronizer.WaitSet();
        if (!set && set.error() == hal::Error::kEndOfStream && i > 0) break;
        if (!set) return CameraFailure(set.error());
        if (pipeline.Prime(set.value())) break;
    }
    pipeline.Start();
    return hal::Done{};
}

bool Limited(const RunOptions& options, std::uint64_t taken) {
    return options.frames && taken >= static_cast<std::uint64_t>(*options.frames);
}

/// The first pass over the recordings; the cameras are used up by that.
hal::Checked<hal::Done> Learn(Board& board, algo::OfflineUnifiedVertexMotion& motion,
                              const RunOptions& options, algo::TaskRunner& workers,
                              const std::atomic<bool>& stop) {
    FrameSynchronizer synchronizer(board.cameras());
    for (std::uint64_t taken = 0; !stop && !Limited(options, taken); ++taken) {
        const auto set = synchronizer.WaitSet();
        if (!set && set.error() == hal::Error::kEndOfStream) break;
        if (!set) return CameraFailure(set.error());
        motion.Learn(Borrow(set.value()), workers);
        if (options.progress) options.progress("learnt", taken + 1);
    }
    motion.Solve();
    return hal::Done{};
}

/// What is known of a run before its first frame.
RunSummary EmptySummary(const RigConfig& config, const Board& board, const RigGeometry& rig,
                        const std::optional<calib::RigCalibration>& calibration) {
    RunSummary summary;
    summary.period_ms = std::chrono::duration<double, std::milli>(board.period()).count();
    if (calibration) summary.calibration_id = calibration->id();
    summary.ring = rig.canvas.IsRing();
    for (const algo::Unit unit : algo::kUnits) {
        summary.cameras[unit] = static_cast<int>(config.units[unit].cameras.size());
    }
    return summary;
}

/// From READY on, which is its construction, memory is watched; until its destruction at most.
class MemoryWatch {
 public:
    explicit MemoryWatch(bool trap) : at_ready_(ReadResources()) {
        StartCountingHeapCalls(trap ? OnHeapCall::kTrap : OnHeapCall::kCount);
    }
    ~MemoryWatch() { StopCountingHeapCalls(); }
    MemoryWatch(const MemoryWatch&) = delete;
    MemoryWatch& operator=(const MemoryWatch&) = delete;

    /// Ends the watch.
    MemorySummary Finish() {
        StopCountingHeapCalls();
        return {CountHeapCalls(), at_ready_, ReadResources()};
    }

 private:
    Resources at_ready_;
};

/// Drives one opened rig; see RunRig.
class Run {
 public:
    Run(Board& board, Pipeline& pipeline, RunOutputs& outputs, const RunOptions& options,
        RunSummary& summary)
        : board_(board),
          pipeline_(pipeline),
          outputs_(outputs),
          options_(options),
          summary_(summary) {}

    hal::Checked<hal::Done> Loop(const std::atomic<bool>& stop, const ShownHook& hook) {
        FrameSynchronizer synchronizer(board_.cameras());
        start_ = board_.clock().Now();
        outputs_.Start(start_);
        MemoryWatch memory(options_.trap_alloc);
        std::uint64_t taken = 0;
        while (!stop && !Limited(options_, taken)) {
            auto set = synchronizer.WaitSet();
            if (!set && set.error() == hal::Error::kEndOfStream) break;
            if (!set) return CameraFailure(set.error());
            ++taken;
            if (options_.realtime && !WaitForTurn(set->sequence)) continue;
            const ShownPanorama* shown = pipeline_.Process(std::move(*set));
            CountDeadline();
            if (shown != nullptr) {
                if (const auto done = Show(*shown, hook); !done) return done;
            }
        }
        while (const ShownPanorama* shown = pipeline_.Flush()) {
            if (const auto done = Show(*shown, hook); !done) return done;
        }
        summary_.memory = memory.Finish();
        summary_.times = pipeline_.times();
        summary_.duration_s = std::chrono::duration<double>(board_.clock().Now() - start_).count();
        return hal::Done{};
    }

 private:
    /// False when the set's turn is over: it is dropped, so that no latency queues up.
    bool WaitForTurn(std::uint32_t sequence) {
        const hal::Instant due = start_ + board_.period() * sequence;
        if (board_.clock().Now() > due + board_.period()) {
            ++summary_.dropped;
            return false;
        }
        board_.clock().SleepUntil(due);
        return true;
    }

    void CountDeadline() {
        summary_.newest_total_ms =
            pipeline_.times()[static_cast<std::size_t>(Stage::kTotal)].last_ms();
        if (summary_.newest_total_ms > summary_.period_ms) ++summary_.deadline_misses;
    }

    hal::Checked<hal::Done> Show(const ShownPanorama& shown, const ShownHook& hook) {
        ++summary_.frames;
        for (const algo::Overlap overlap : algo::kOverlaps) {
            if (shown.composition->seams[overlap] == algo::SeamState::kLocked)
                ++summary_.locked_frames[overlap];
        }
        if (const auto& known = shown.composition->articulation) summary_.articulation.Add(*known);
        if (options_.offline && options_.progress) options_.progress("shown", summary_.frames);
        const auto done = outputs_.Show(shown, pipeline_, summary_);
        if (done && hook) hook(shown, pipeline_);
        return done;
    }

    Board& board_;
    Pipeline& pipeline_;
    RunOutputs& outputs_;
    const RunOptions& options_;
    RunSummary& summary_;
    hal::Instant start_{};
};

}  // namespace

void ArticulationSummary::Add(const algo::Articulation& articulation) {
    const double angle_rad = articulation.angle_rad;
    least_rad = frames == 0 ? angle_rad : std::min(least_rad, angle_rad);
    most_rad = frames == 0 ? angle_rad : std::max(most_rad, angle_rad);
    variances += articulation.sigma_rad * articulation.sigma_rad;
    ++frames;
}

hal::Checked<RunSummary> RunRig(const RigConfig& config, const RunOptions& options,
                                const std::atomic<bool>& stop, const ShownHook& hook) {
    auto calibration = Calibration(config);
    if (!calibration) return calibration.error();
    const algo::UnifiedVertexMotionOptions motion_options = MotionOptions(config, options);
    const int held = motion_options.lookahead_frames + 2;
    auto board = Board::Open(config, held);
    if (!board) return board.error();
    const auto rig = MakeRigGeometry(config, *calibration, (*board)->formats());
    if (!rig) return rig.error();

    WorkerPool workers(options.workers.value_or(config.workers));
    const Motion motion = MakeMotion(rig.value(), motion_options, options);
    Pipeline pipeline(rig.value(), *motion.any, workers);
    if (const auto primed = Prime(**board, pipeline); !primed) return primed.error();
    // A recording starts again from its first frame.
    board = Board::Open(config, held);
    if (!board) return board.error();
    if (motion.offline != nullptr) {
        if (const auto learnt = Learn(**board, *motion.offline, options, workers, stop); !learnt)
            return learnt.error();
        board = Board::Open(config, held);
        if (!board) return board.error();
    }

    RunSummary summary = EmptySummary(config, **board, rig.value(), *calibration);
    if (const auto made = MakeFolder(options.out); !made) return made.error();
    auto outputs = RunOutputs::Open(config, options, **board, summary, pipeline.format());
    if (!outputs) return outputs.error();
    const auto done = Run(**board, pipeline, **outputs, options, summary).Loop(stop, hook);
    pipeline.Start();  // gives the last leases back while the cameras live
    const auto finished = (*outputs)->Finish();
    if (!done) return done.error();
    if (!finished) return finished.error();
    summary.dropped += (*outputs)->dropped();
    return summary;
}

}  // namespace hitchview::app
