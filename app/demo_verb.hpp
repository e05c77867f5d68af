#pragma once

#include <atomic>
#include <filesystem>
#include <string>

namespace hitchview::app {

struct DemoOptions {
    bool headless = false;                   ///< open no window
    std::filesystem::path out = "out/demo";  ///< recording, rig file, videos, picture, report
    int frames = 210;                        ///< frame sets of the drive, 30 per second. [30, 3000]
    int camera_width_px = 1280;  ///< of the simulated cameras, 16:9. 320, 640, 960, 1280 or 1920
    std::string scenario{};      ///< of the drive; empty: a slow slalom through narrow curves
    std::filesystem::path faults{};  ///< script of what happens to the cameras; empty: nothing
    int workers = 2;             ///< [1, 16]
    bool realtime = false;       ///< one frame set per period; late ones are dropped
};

/// Drives the simulated vehicle through the whole real pipeline: renders the drive once into JPEG
/// files, replays it through estimation, renderer and LCM, measures the result against the truth
/// and writes panorama.avi, before_after.png and report.json: the report of a run, with the figures
/// of ScenarioMeter in `truth.after`, and in `truth.before` those of the fixed calibration alone.
/// Returns the exit code.
int DemoVerb(const DemoOptions& options, const std::atomic<bool>& stop);

}  // namespace hitchview::app
