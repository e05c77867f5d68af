#include "app/run_outputs.hpp"

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

/// Why a video cannot be continued.
std::string Refusal(VideoWriter& video) {
    return "cannot write the video: " + video.Finish().error();
}

}  // namespace

hal::Checked<std::unique_ptr<RunOutputs>> RunOutputs::Open(const RigConfig& config,
                                                           const RunOptions& options, Board& board,
                                                           const RunSummary& run,
                                                           const hal::FrameFormat& format) {
    std::unique_ptr<RunOutputs> outputs(new RunOutputs);
    outputs->speed_ = options.speed;
    if (const auto videos = outputs->OpenVideos(options, run, format); !videos)
        return videos.error();
    if (const auto recording = outputs->OpenRecording(config, options, board, run); !recording)
        return recording.error();
    if (const auto publisher = outputs->OpenPublisher(config, options, board); !publisher)
        return publisher.error();
    if (outputs->receivers_) outputs->StartPublishing(config, options, board, run, format);
    return outputs;
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

hal::Checked<hal::Done> RunOutputs::OpenPublisher(const RigConfig& config,
                                                  const RunOptions& options, Board& board) {
    if (!options.publish) return hal::Done{};
    auto network = board.OpenPublisher(config.publish);
    if (!network) return network.error();
    if (receivers_)
        receivers_ = std::make_unique<TeePublisher>(std::move(*network), std::move(receivers_));
    else
        receivers_ = std::move(*network);
    return hal::Done{};
}

void RunOutputs::StartPublishing(const RigConfig& config, const RunOptions& options, Board& board,
                                 const RunSummary& run, const hal::FrameFormat& format) {
    can_bus_ = board.can_bus();
    if (can_bus_ != nullptr && recorder_) {
        recorded_can_ =
            std::make_unique<RecordedCanBus>(*can_bus_, board.is_can_live(), recorder_->intake());
        can_bus_ = recorded_can_.get();
    }
    if (can_bus_ != nullptr) {
        const bool live = board.is_can_live();
        telemetry_ = std::make_unique<TelemetryThread>(
            *can_bus_, config.can->hitch_angle,
            TelemetryOptions{.paced = !live, .clock = live ? &board.clock() : nullptr});
    }
    publisher_ = std::make_unique<PanoramaPublisher>(
        *receivers_, board.clock(),
        SentBeside{.telemetry = telemetry_.get(), .events = &board.events()}, format,
        PanoramaPublisherOptions{.jpeg = {.budget_bytes = config.publish.max_bytes,
                                          .highest_quality = config.publish.jpeg_quality},
                                 .calibration_id = run.calibration_id,
                                 .drop_when_late = options.realtime,
                                 .speed = options.speed,
                                 .live_telemetry = board.is_can_live(),
                                 .threads = options.workers.value_or(config.workers)});
}

void RunOutputs::Start(hal::Instant start) {
    start_ = start;
    if (publisher_) publisher_->StartRecording(start);
    if (recorder_) recorder_->Start(start);
}

hal::Checked<hal::Done> RunOutputs::Show(const ShownPanorama& shown, Pipeline& pipeline,
                                         const RunSummary& run) {
    if (publisher_) Publish(shown, run);
    if (panorama_ && !panorama_->Append(shown.picture)) return Refusal(*panorama_);
    for (const algo::Unit unit : algo::kUnits) {
        if (!views_[unit]) continue;
        if (!views_[unit]->Append(pipeline.RenderView(unit))) return Refusal(*views_[unit]);
    }
    return hal::Done{};
}

void RunOutputs::Publish(const ShownPanorama& shown, const RunSummary& run) {
    if (telemetry_) telemetry_->Advance(shown.captured_until);
    hal::FrameView picture = shown.picture;
    const hal::Instant captured_from = OnThisClock(picture.header.captured_at);
    picture.header.captured_at = captured_from;
    publisher_->Append({.picture = picture,
                        .captured_until = OnThisClock(shown.captured_until),
                        .status = Status(shown, run, captured_from)});
}

hal::Instant RunOutputs::OnThisClock(hal::Instant captured) const {
    return start_ + AtSpeed(captured, speed_);
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
    if (publisher_) publisher_->Finish();
    if (recorder_) recorder_->Finish();
    for (VideoWriter* video : {panorama_.get(), views_[algo::Unit::kTractor].get(),
                               views_[algo::Unit::kTrailer].get()}) {
        if (video == nullptr) continue;
        if (const auto finished = video->Finish(); !finished) return finished.error();
    }
    return hal::Done{};
}

}  // namespace hitchview::app
