#pragma once

#include <filesystem>
#include <optional>

#include "app/bench_frames.hpp"
#include "app/recorder.hpp"
#include "app/rig_geometry.hpp"
#include "app/stage_times.hpp"

namespace hitchview::app {

/// What a run at the cameras' pace was like.
struct PacedFigures {
    double p50_ms = 0;  ///< from the frame set's moment to the compressed panorama
    double p99_ms = 0;
    int dropped = 0;          ///< panoramas never published
    int deadline_misses = 0;  ///< that took longer than a period
};

/// What a run of the whole pipeline with its publisher cost.
struct BenchFigures {
    double core_ms = 0;      ///< CPU time of a frame set, summed over threads, without publishing
    double jpeg_ms = 0;      ///< CPU time of compressing and publishing it
    double jpeg_bytes = 0;   ///< median
    double growth = 0;       ///< CPU time of the last tenth of the sets to that of the first
    double interval_ms = 0;  ///< median from one panorama to the next, as fast as it goes
    PacedFigures paced{};
    /// Paced, with a recorder beside it: what it was like and what was recorded.
    PacedFigures recorded{};
    std::optional<RecordingSummary> recording{};
    AllStageTimes times{};  ///< wall
};

struct BenchRunOptions {
    int workers = 2;
    int frames = 120;                      ///< of each kind of run
    std::optional<hal::Instant> period{};  ///< also paced, at this period
    std::filesystem::path record{};        ///< and once more while it records; empty: not
};

/// Drives the pipeline of this geometry with the frames from memory, warm-up first.
BenchFigures RunBench(const RigGeometry& geometry, BenchFrames& frames,
                      const BenchRunOptions& options);

}  // namespace hitchview::app
