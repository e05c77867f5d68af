#pragma once

#include <atomic>
#include <filesystem>

#include "hal/frame.hpp"

namespace hitchview::app {

struct BenchOptions {
    int workers = 2;  ///< [1, kMaxWorkers]
    int canvas_width_px = 4096;
    int camera_width_px = 1280;
    hal::PixelFormat format = hal::PixelFormat::kUyvy;  ///< of the cameras: also kNv12, kYuyv
    int frames = 120;                                   ///< of each run
    int rounds = 3;                                     ///< whole runs; the median counts
    bool quick = false;              ///< one round, and no scaling over cameras, widths and workers
    std::filesystem::path record{};  ///< folder; also measured while it records; empty: not
    std::filesystem::path cache;     ///< folder for rendered frames; empty: none
    std::filesystem::path json;      ///< file for all figures; empty: none
};

/// Measures what this machine does with eight simulated cameras, whose frames lie in memory, beside
/// memcpy and OpenCV's remap in the same run. Returns the exit code: 0 whatever the figures are, 1
/// stopped, 3 the machine failed.
int BenchVerb(const BenchOptions& options, const std::atomic<bool>& stop);

}  // namespace hitchview::app
