#include "app/run_loop.hpp"

#include <algorithm>
#include <system_error>

#include "algo/offline_unified_vertex_motion.hpp"
#include "algo/unified_vertex_motion.hpp"
#include "app/board.hpp"
#include "app/calibration_mismatch.hpp"
#include "app/camera_watch.hpp"
#include "app/first_sets.hpp"
#include "app/log_rig.hpp"
#include "app/panorama_loop.hpp"
#include "app/real_time.hpp"
#include "app/run_outputs.hpp"
#include "app/worker_pool.hpp"

namespace hitchview::app {
namespace {

/// How long live cameras may take to start.
constexpr std::chrono::seconds kLongestStart{3};

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
hal::Checked<hal::Done> Prime(Board& board, Pipeline& pipeline, const std::atomic<bool>& stop) {
    const StartPatience patience{
        .sets = board.live() == nullptr ? 0 : static_cast<int>(kLongestStart / board.period()),
        .cameras_awaited = board.cameras_awaited()};
    const auto look = [&](const FrameSet& set) { return pipeline.Prime(set); };
    const auto shown = ShowFirstSets(board.sets(), patience, look, stop);
    if (!shown) return CameraFailure(shown.error());
    pipeline.Start();
    return hal::Done{};
}

std::vector<WatchedPicture> WatchedPictures(const RigConfig& config) {
    std::vector<WatchedPicture> pictures;
    for (const algo::Unit unit : algo::kUnits) {
        const auto& cameras = config.units[unit].cameras;
        for (std::size_t i = 0; i < cameras.size(); ++i)
            pictures.push_back({cameras[i].name, unit, i});
    }
    return pictures;
}

/// Videos and pictures may repeat themselves, and be as black as they like.
bool IsWatched(const RigConfig& config, const RunOptions& options) {
    if (options.offline) return false;
    if (options.faults) return true;
    for (const algo::Unit unit : algo::kUnits) {
        for (const CameraConfig& camera : config.units[unit].cameras)
            if (camera.ReadsPictures()) return false;
    }
    return true;
}

bool Limited(const RunOptions& options, std::uint64_t taken) {
    return options.frames && taken >= static_cast<std::uint64_t>(*options.frames);
}

/// The first pass over the recordings; the cameras are used up by that.
hal::Checked<hal::Done> Learn(Board& board, algo::OfflineUnifiedVertexMotion& motion,
                              const RunOptions& options, algo::TaskRunner& workers,
                              const std::atomic<bool>& stop) {
    for (std::uint64_t taken = 0; !stop && !Limited(options, taken); ++taken) {
        const auto set = board.sets().WaitSet();
        if (!set && set.error() == hal::Error::kEndOfStream) break;
        if (!set) return CameraFailure(set.error());
        motion.Learn(Borrow(set.value()), workers);
        if (options.progress) options.progress("learnt", taken + 1);
    }
    motion.Solve();
    return hal::Done{};
}

/// Tells the display units why no picture will come; whether they can be told changes nothing.
void TellRefusal(const RigConfig& config, Board& board, const std::string& why) {
    const auto network = board.OpenPublisher(config.publish);
    if (!network) return;
    [[maybe_unused]] const auto told =
        network.value()->Publish(CalibrationRefused(why, board.clock().Now()));
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

/// Adds what cameras and outputs know when they have ended.
void Complete(const RigConfig& config, Board& board, const RunOutputs& outputs,
              RunSummary& summary) {
    summary.dropped += outputs.dropped();
    if (LiveFrameSynchronizer* const live = board.live()) {
        live->Finish();
        summary.live = live->Summarise();
    }
    summary.events = board.events().counts();
    summary.publishing = outputs.times();
    summary.can = outputs.can();
    summary.recording = outputs.recording();
    for (const algo::Unit unit : algo::kUnits) {
        for (std::size_t i = 0; i < config.units[unit].cameras.size(); ++i)
            summary.pools.push_back(
                {config.units[unit].cameras[i].name, board.cameras()[unit][i]->pool()});
    }
    outputs.AddPools(summary.pools);
}

/// Of a rig whose logs are resolved.
hal::Checked<RunSummary> Run(const RigConfig& config, const RunOptions& options,
                             const std::atomic<bool>& stop, const ShownHook& hook) {
    if (config.IsLive() && !options.realtime)
        return config.file.string() +
               ": its cameras are live: use run; the other verbs need recordings";
    auto calibration = Calibration(config);
    if (!calibration) return calibration.error();
    if (options.realtime) {
        const auto prepared = PrepareRealTime(config.real_time);
        if (!prepared) return prepared.error();
    }
    const algo::UnifiedVertexMotionOptions motion_options = MotionOptions(config, options);
    const Board::Options opened{.held_frames = motion_options.lookahead_frames + 2 +
                                               RunOutputs::HeldFrames(config, options),
                                .recorded = options.record && !config.record.folder.empty(),
                                .awaits_cameras = options.realtime,
                                .faults = options.faults ? &*options.faults : nullptr};
    auto board = Board::Open(config, opened);
    if (!board) return board.error();
    const auto rig = MakeRigGeometry(config, *calibration, (*board)->formats());
    if (!rig) {
        if (options.publish) TellRefusal(config, **board, rig.error());
        return rig.error();
    }

    WorkerPool workers(options.workers.value_or(config.workers),
                       options.realtime ? config.schedule : ThreadSchedule{});
    if (options.realtime && config.schedule.given())
        LogSteps({{"workers scheduled", workers.refusal()}});
    const Motion motion = MakeMotion(rig.value(), motion_options, options);
    Pipeline pipeline(rig.value(), *motion.any, workers);
    if (const auto primed = Prime(**board, pipeline, stop); !primed) return primed.error();
    // A recording starts again from its first frame.
    if ((*board)->live() == nullptr) board = Board::Open(config, opened, std::move(*board));
    if (board && motion.offline != nullptr) {
        if (const auto learnt = Learn(**board, *motion.offline, options, workers, stop); !learnt)
            return learnt.error();
        board = Board::Open(config, opened, std::move(*board));
    }
    if (!board) return board.error();

    RunSummary summary = EmptySummary(config, **board, rig.value(), *calibration);
    const hal::Instant now = (*board)->clock().Now();
    for (const hal::Event& event : CalibrationMismatches(config, *calibration, now))
        (*board)->events().Put(event);
    if (const auto made = MakeFolder(options.out); !made) return made.error();
    auto outputs = RunOutputs::Open(config, options, {**board, rig.value(), pipeline}, summary);
    if (!outputs) return outputs.error();
    if (options.realtime) EnterRealTime(config.schedule);
    const hal::Instant period = (*board)->period();
    CameraWatch watch(
        WatchedPictures(config), period, (*board)->events(), (*board)->clock(),
        (*board)->live() != nullptr ? CameraWatch::LivePatience(period) : hal::Instant{});
    if (IsWatched(config, options)) pipeline.SetWatch(&watch);
    PanoramaLoop loop({**board, *motion.any, pipeline, **outputs}, options, summary);
    const auto done = loop.Run(stop, hook);
    pipeline.SetWatch(nullptr);
    pipeline.Start();  // gives the last leases back while the cameras live
    const auto finished = (*outputs)->Finish();
    if (!done) return done.error();
    if (!finished) return finished.error();
    Complete(config, **board, **outputs, summary);
    return summary;
}

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
    auto resolved = ResolveLogs(config, stop);
    if (!resolved) return resolved.error();
    if (options.faults) {
        if (const auto checked = CheckCameras(*options.faults, *resolved); !checked)
            return checked.error();
        TakeDrive(*options.faults, *resolved);
    }
    return Run(resolved.value(), options, stop, hook);
}

}  // namespace hitchview::app
