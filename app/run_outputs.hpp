#pragma once

#include <memory>
#include <optional>

#include "app/panorama_publisher.hpp"
#include "app/pipeline.hpp"
#include "app/recorded_can_bus.hpp"
#include "app/recorder.hpp"
#include "app/run_loop.hpp"
#include "app/telemetry_thread.hpp"
#include "app/video_writer.hpp"

namespace hitchview::app {

class Board;

/// Where the panoramas of a run go: videos, the network and a recording.
class RunOutputs final : private ShownSets {
 public:
    /// What it is opened on; all must outlive it.
    struct Parts {
        Board& board;
        const RigGeometry& rig;
        Pipeline& pipeline;
    };
    static hal::Checked<std::unique_ptr<RunOutputs>> Open(const RigConfig& config,
                                                          const RunOptions& options,
                                                          const Parts& parts,
                                                          const RunSummary& run);
    /// Frame sets that it may hold beside the pipeline's.
    static int HeldFrames(const RigConfig& config, const RunOptions& options) {
        return options.publish && config.publish.preview.rate_hz > 0 ? 1 : 0;
    }

    ~RunOutputs() override;

    /// Before the first Show, and again when the recording's pace slips: CLOCK_MONOTONIC moment of
    /// its moment 0.
    void Start(hal::Instant start);
    /// `run`: counts so far.
    hal::Checked<hal::Done> Show(const ShownPanorama& shown, Pipeline& pipeline,
                                 const RunSummary& run);
    hal::Checked<hal::Done> Finish();
    /// After Finish; empty times where nothing was published.
    [[nodiscard]] PublishTimes times() const {
        return publisher_ ? publisher_->times() : PublishTimes{};
    }
    /// Of the CAN bus so far; empty where none is read.
    [[nodiscard]] std::optional<CanSummary> can() const;
    /// After Finish; empty where nothing was recorded.
    [[nodiscard]] std::optional<RecordingSummary> recording() const;
    void AddPools(std::vector<PoolSummary>& pools) const;
    [[nodiscard]] std::uint64_t dropped() const { return publisher_ ? publisher_->dropped() : 0; }

 private:
    RunOutputs() = default;
    hal::Checked<hal::Done> OpenVideos(const RunOptions& options, const RunSummary& run,
                                       const hal::FrameFormat& format);
    hal::Checked<hal::Done> OpenRecording(const RigConfig& config, const RunOptions& options,
                                          Board& board, const RunSummary& run);
    hal::Checked<hal::Done> OpenNetwork(const RigConfig& config, Board& board);
    hal::Checked<SideSources> OpenSideSources(const RigConfig& config, const Parts& parts);
    void OpenTelemetry(const RigConfig& config, Board& board);
    hal::Checked<hal::Done> OpenWatchdog(const RunOptions& options);
    hal::Checked<hal::Done> StartPublishing(const RigConfig& config, const RunOptions& options,
                                            const Parts& parts, const RunSummary& run);
    /// Previews are made of sets that were shown.
    void DoOffer(FrameSet& set) override;
    void Publish(const ShownPanorama& shown, const Pipeline& pipeline, const RunSummary& run);

    /// Of a moment of the cameras' time.
    [[nodiscard]] hal::Instant OnThisClock(hal::Instant captured) const;

    hal::Instant start_{};
    double speed_ = 1;              ///< of the cameras' time
    Pipeline* pipeline_ = nullptr;  // while it offers its sets
    std::unique_ptr<VideoWriter> panorama_;
    algo::PerUnit<std::unique_ptr<VideoWriter>> views_;
    std::unique_ptr<Recorder> recorder_;
    std::unique_ptr<hal::Publisher> receivers_;  ///< display units, the recording, or both
    std::unique_ptr<RecordedCanBus> recorded_can_;
    hal::CanBus* can_bus_ = nullptr;
    std::unique_ptr<TelemetryThread> telemetry_;
    const hal::Clock* clock_ = nullptr;
    std::unique_ptr<RunWatch> watch_;
    std::unique_ptr<OverlayMaker> overlay_;
    std::unique_ptr<PreviewThread> previews_;
    std::unique_ptr<hal::Watchdog> watchdog_;
    std::unique_ptr<PanoramaPublisher> publisher_;
};

}  // namespace hitchview::app
