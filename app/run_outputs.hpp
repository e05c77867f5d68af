#pragma once

#include <memory>
#include <optional>

#include "app/panorama_publisher.hpp"
#include "app/pipeline.hpp"
#include "app/run_loop.hpp"
#include "app/telemetry_thread.hpp"
#include "app/video_writer.hpp"

namespace hitchview::app {

class Board;

/// Where the panoramas of a run go: videos and the network.
class RunOutputs {
 public:
    static hal::Checked<std::unique_ptr<RunOutputs>> Open(const RigConfig& config,
                                                          const RunOptions& options, Board& board,
                                                          const RunSummary& run,
                                                          const hal::FrameFormat& format);

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
    void AddPools(std::vector<PoolSummary>& pools) const;
    [[nodiscard]] std::uint64_t dropped() const { return publisher_ ? publisher_->dropped() : 0; }

 private:
    RunOutputs() = default;
    hal::Checked<hal::Done> OpenVideos(const RunOptions& options, const RunSummary& run,
                                       const hal::FrameFormat& format);
    hal::Checked<hal::Done> OpenNetwork(const RigConfig& config, const RunOptions& options,
                                        Board& board, const RunSummary& run,
                                        const hal::FrameFormat& format);
    void Publish(const ShownPanorama& shown, const Pipeline& pipeline, const RunSummary& run);

    hal::Instant start_{};
    std::unique_ptr<VideoWriter> panorama_;
    algo::PerUnit<std::unique_ptr<VideoWriter>> views_;
    std::unique_ptr<hal::Publisher> network_;
    hal::CanBus* can_bus_ = nullptr;
    std::unique_ptr<TelemetryThread> telemetry_;
    const hal::Clock* clock_ = nullptr;
    std::unique_ptr<RunWatch> watch_;
    std::unique_ptr<PanoramaPublisher> publisher_;
};

}  // namespace hitchview::app
