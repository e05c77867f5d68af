#include "app/run_outputs.hpp"

#include <cstdio>

#include "app/board.hpp"
#include "app/playback_speed.hpp"
#include "app/record_setup.hpp"
#include "app/tee_publisher.hpp"

namespace hitchview::app {
namespace {

hal::SeamState ToHal(algo::SeamState state) {
    switch (state) {
        case algo::SeamState::kNoOverlap:
            return hal::SeamState::kNoOverlap;
        case algo::SeamState::kReacquire:
            return hal::SeamState::kReacquire;
        case algo::SeamState::kCoast:
            return hal::SeamState::kCoast;
        case algo::SeamState::kLocked:
            return hal::SeamState::kLocked;
    }
    return hal::SeamState::kNoOverlap;
}

hal::PanoramaStatus Status(const ShownPanorama& shown, const RunSummary& run,
                           hal::Instant captured_from) {
    const algo::Composition& c = *shown.composition;
    hal::PanoramaStatus status;
    status.sequence = shown.picture.header.sequence;
    status.captured_from = captured_from;
    status.spread = shown.captured_until - shown.picture.header.captured_at;
    status.cameras_missing = shown.cameras_missing;
    for (const algo::Overlap overlap : algo::kOverlaps) {
        const auto i = static_cast<std::size_t>(overlap);
        status.seams[i] = ToHal(c.seams[overlap]);
        status.seam_matches[i] = c.matches[overlap];
    }
    for (const algo::Unit unit : algo::kUnits) {
        status.unit_features[static_cast<std::size_t>(unit)] = c.features[unit];
    }
    if (c.articulation) {
        status.articulation_rad = c.articulation->angle_rad;
        status.articulation_sigma_rad = c.articulation->sigma_rad;
    }
    status.total_ms = run.newest_total_ms;
    status.deadline_misses = run.deadline_misses;
    status.dropped = run.dropped;
    return status;
}

FrameFigures Figures(const hal::PanoramaStatus& status, const ShownPanorama& shown,
                     hal::Instant captured_until, const Pipeline& pipeline, const RunSummary& run) {
    FrameFigures figures{.panoramas = run.frames,
                         .dropped = run.dropped,
                         .deadline_misses = run.deadline_misses,
                         .cameras_missing = shown.cameras_missing,
                         .camera_states = shown.camera_states,
                         .captured_until = captured_until,
                         .seams = {status.seams},
                         .matches = {status.seam_matches}};
    for (std::size_t i = 0; i < figures.stage_ms.size(); ++i)
        figures.stage_ms[i] = static_cast<float>(pipeline.times()[i].last_ms());
    return figures;
}

/// Whose health is told: cameras in the order of the bits of cameras_missing.
HealthOptions HealthOf(const RigConfig& config, const RunOptions& options, Board& board,
                       const RunSummary& run, const Recorder* recorder) {
    HealthOptions health{.version = HITCHVIEW_VERSION,
                         .calibration_id = run.calibration_id,
                         .cameras = {},
                         .paced = options.realtime,
                         .recorder = recorder};
    for (const algo::Unit unit : algo::kUnits) {
        for (std::size_t i = 0; i < config.units[unit].cameras.size(); ++i) {
            const bool live = board.live() != nullptr;
            health.cameras.push_back({config.units[unit].cameras[i].name, unit,
                                      live ? board.cameras()[unit][i].get() : nullptr});
        }
    }
    return health;
}

/// `sent`: over the network; a recording alone has no receive buffer.
ReceiveBufferVerdict ReceiveBuffer(const PublishConfig& publish, bool sent) {
    const bool network = sent && publish.url.find("udpm://") != std::string::npos;
    return JudgeReceiveBuffer(publish.max_bytes,
                              network ? Board::ReceiveBufferBytes() : std::nullopt,
                              publish.fit_receive_buffer);
}

hal::Instant PeriodOf(double rate_hz) {
    return hal::Instant(static_cast<hal::Instant::rep>(1e9 / rate_hz));
}

/// Why a video cannot be continued.
std::string Refusal(VideoWriter& video) {
    return "cannot write the video: " + video.Finish().error();
}

}  // namespace

hal::Checked<std::unique_ptr<RunOutputs>> RunOutputs::Open(const RigConfig& config,
                                                           const RunOptions& options,
                                                           const Parts& parts,
                                                           const RunSummary& run) {
    std::unique_ptr<RunOutputs> outputs(new RunOutputs);
    outputs->speed_ = options.speed;
    if (const auto videos = outputs->OpenVideos(options, run, parts.pipeline.format()); !videos)
        return videos.error();
    if (const auto recording = outputs->OpenRecording(config, options, parts.board, run);
        !recording)
        return recording.error();
    if (options.publish) {
        if (const auto network = outputs->OpenNetwork(config, parts.board); !network)
            return network.error();
    }
    if (!outputs->receivers_) return outputs;
    if (const auto started = outputs->StartPublishing(config, options, parts, run); !started)
        return started.error();
    parts.pipeline.SetShownSets(outputs.get());
    outputs->pipeline_ = &parts.pipeline;
    return outputs;
}

RunOutputs::~RunOutputs() {
    if (pipeline_ != nullptr) pipeline_->SetShownSets(nullptr);
}

hal::Checked<hal::Done> RunOutputs::OpenVideos(const RunOptions& options, const RunSummary& run,
                                               const hal::FrameFormat& format) {
    const auto open = [&](const char* name,
                          std::unique_ptr<VideoWriter>& video) -> hal::Checked<hal::Done> {
        const std::string path = (options.out / (std::string(name) + ".avi")).string();
        auto opened =
            VideoWriter::Open(path, format, {.name = name, .rate_hz = 1000 / run.period_ms});
        if (!opened) return opened.error();
        video = std::move(*opened);
        return hal::Done{};
    };
    if (options.write_video) {
        if (const auto opened = open("panorama", panorama_); !opened) return opened;
    }
    for (const algo::Unit unit : algo::kUnits) {
        if (!options.write_views || run.cameras[unit] == 0) continue;
        if (const auto opened = open(ToString(unit), views_[unit]); !opened) return opened;
    }
    return hal::Done{};
}

hal::Checked<hal::Done> RunOutputs::OpenRecording(const RigConfig& config,
                                                  const RunOptions& options, Board& board,
                                                  const RunSummary& run) {
    auto recorder = OpenRecorder(config, options, run, board);
    if (!recorder) return recorder.error();
    recorder_ = std::move(*recorder);
    if (!recorder_) return hal::Done{};
    auto receiver = OpenRecordingPublisher(config.publish, board.clock(), *recorder_);
    if (!receiver) return receiver.error();
    receivers_ = std::move(*receiver);
    return hal::Done{};
}

hal::Checked<hal::Done> RunOutputs::OpenNetwork(const RigConfig& config, Board& board) {
    auto network = board.OpenPublisher(config.publish);
    if (!network) return network.error();
    if (receivers_)
        receivers_ = std::make_unique<TeePublisher>(std::move(*network), std::move(receivers_));
    else
        receivers_ = std::move(*network);
    return hal::Done{};
}

void RunOutputs::OpenTelemetry(const RigConfig& config, Board& board) {
    can_bus_ = board.can_bus();
    if (can_bus_ == nullptr) return;
    const bool live = board.is_can_live();
    if (recorder_) {
        recorded_can_ = std::make_unique<RecordedCanBus>(*can_bus_, live, recorder_->intake());
        can_bus_ = recorded_can_.get();
    }
    telemetry_ = std::make_unique<TelemetryThread>(
        *can_bus_, config.can->hitch_angle,
        TelemetryOptions{.paced = !live, .clock = live ? &board.clock() : nullptr});
}

hal::Checked<SideSources> RunOutputs::OpenSideSources(const RigConfig& config, const Parts& parts) {
    const PublishConfig& publish = config.publish;
    auto viewports = MakeViewports(publish, parts.rig.canvas);
    if (!viewports) return config.file.string() + ": " + viewports.error();
    if (publish.overlay.rate_hz > 0) {
        overlay_ = std::make_unique<OverlayMaker>(parts.rig, parts.pipeline.map().block_px(),
                                                  PeriodOf(publish.overlay.rate_hz));
    }
    if (publish.preview.rate_hz > 0) {
        PreviewOptions options{.cameras = {}, .period = PeriodOf(publish.preview.rate_hz)};
        for (const algo::Unit unit : algo::kUnits) {
            for (const CameraConfig& camera : config.units[unit].cameras)
                options.cameras[unit].push_back(camera.name);
        }
        previews_ = std::make_unique<PreviewThread>(options);
    }
    return SideSources{.viewports = std::move(*viewports),
                       .highest_quality = publish.jpeg_quality,
                       .overlay = overlay_.get(),
                       .previews = previews_.get()};
}

hal::Checked<hal::Done> RunOutputs::OpenWatchdog(const RunOptions& options) {
    if (!options.realtime) return hal::Done{};
    auto watchdog = Board::OpenWatchdog();
    if (!watchdog) return watchdog.error();
    watchdog_ = std::move(*watchdog);
    return hal::Done{};
}

hal::Checked<hal::Done> RunOutputs::StartPublishing(const RigConfig& config,
                                                    const RunOptions& options, const Parts& parts,
                                                    const RunSummary& run) {
    Board& board = parts.board;
    clock_ = &board.clock();
    OpenTelemetry(config, board);
    auto side =
        options.publish ? OpenSideSources(config, parts) : hal::Checked<SideSources>(SideSources{});
    if (!side) return side.error();
    if (const auto opened = OpenWatchdog(options); !opened) return opened;
    const ReceiveBufferVerdict buffer = ReceiveBuffer(config.publish, options.publish);
    if (!buffer.warning.view().empty() && !board.events().is_on_stderr())
        std::fprintf(stderr, "publish: %s\n", buffer.warning.c_str());
    const bool seams = run.cameras[algo::Unit::kTrailer] > 0;
    watch_ = std::make_unique<RunWatch>(
        RunWatchOptions{.health = HealthOf(config, options, board, run, recorder_.get()),
                        .overlaps = {{seams && run.ring, seams}},
                        .period = board.period(),
                        .realtime = options.realtime,
                        .receive_buffer = buffer},
        board.events());
    publisher_ = std::make_unique<PanoramaPublisher>(
        *receivers_, board.clock(),
        SentBeside{.telemetry = telemetry_.get(),
                   .events = &board.events(),
                   .watch = watch_.get(),
                   .watchdog = watchdog_.get()},
        parts.pipeline.format(),
        PanoramaPublisherOptions{.jpeg = {.budget_bytes = buffer.budget_bytes,
                                          .highest_quality = config.publish.jpeg_quality},
                                 .calibration_id = run.calibration_id,
                                 .drop_when_late = options.realtime,
                                 .speed = options.speed,
                                 .live_telemetry = board.is_can_live(),
                                 .threads = options.workers.value_or(config.workers),
                                 .side = std::move(*side)});
    return hal::Done{};
}

void RunOutputs::Start(hal::Instant start) {
    start_ = start;
    if (recorder_) recorder_->Start(start);
    if (!publisher_) return;
    publisher_->StartRecording(start);
    watch_->Start(clock_->Now());
}

hal::Checked<hal::Done> RunOutputs::Show(const ShownPanorama& shown, Pipeline& pipeline,
                                         const RunSummary& run) {
    if (publisher_) Publish(shown, pipeline, run);
    if (panorama_ && !panorama_->Append(shown.picture)) return Refusal(*panorama_);
    for (const algo::Unit unit : algo::kUnits) {
        if (!views_[unit]) continue;
        if (!views_[unit]->Append(pipeline.RenderView(unit))) return Refusal(*views_[unit]);
    }
    return hal::Done{};
}

void RunOutputs::Publish(const ShownPanorama& shown, const Pipeline& pipeline,
                         const RunSummary& run) {
    if (telemetry_) telemetry_->Advance(shown.captured_until);
    hal::FrameView picture = shown.picture;
    const hal::Instant captured_from = OnThisClock(picture.header.captured_at);
    const hal::Instant captured_until = OnThisClock(shown.captured_until);
    picture.header.captured_at = captured_from;
    const hal::PanoramaStatus status = Status(shown, run, captured_from);
    if (overlay_) {
        overlay_->Offer({status.sequence, captured_from}, *shown.composition, pipeline.map(),
                        clock_->Now());
    }
    watch_->Add(Figures(status, shown, captured_until, pipeline, run));
    publisher_->Append({.picture = picture, .captured_until = captured_until, .status = status});
}

hal::Instant RunOutputs::OnThisClock(hal::Instant captured) const {
    return start_ + AtSpeed(captured, speed_);
}

void RunOutputs::DoOffer(FrameSet& set) {
    if (!previews_) return;
    const hal::Instant now = clock_->Now();
    if (previews_->IsDue(now)) previews_->Give(std::move(set), start_, now);
}

void RunOutputs::AddPools(std::vector<PoolSummary>& pools) const {
    if (publisher_) pools.push_back({"panorama", publisher_->pool()});
    if (telemetry_) pools.push_back({"hitch_angle", telemetry_->pool()});
}

std::optional<CanSummary> RunOutputs::can() const {
    if (!telemetry_) return std::nullopt;
    const TelemetryCounts angles = telemetry_->counts();
    const hal::CanCounts bus = can_bus_->counts();
    return CanSummary{.frames = angles.frames,
                      .angles = angles.angles,
                      .angles_refused = angles.refused,
                      .dropped = bus.dropped,
                      .errors = bus.errors,
                      .disconnections = bus.disconnections};
}

std::optional<RecordingSummary> RunOutputs::recording() const {
    if (!recorder_) return std::nullopt;
    return recorder_->Summarise();
}

hal::Checked<hal::Done> RunOutputs::Finish() {
    if (recorder_) recorder_->Stop("the program ends");
    if (telemetry_) telemetry_->Settle();
    if (publisher_) publisher_->Finish();
    if (previews_) previews_->Finish();
    if (recorder_) recorder_->Finish();
    for (VideoWriter* video : {panorama_.get(), views_[algo::Unit::kTractor].get(),
                               views_[algo::Unit::kTrailer].get()}) {
        if (video == nullptr) continue;
        if (const auto finished = video->Finish(); !finished) return finished.error();
    }
    return hal::Done{};
}

}  // namespace hitchview::app
