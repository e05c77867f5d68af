#include "app/desk_arguments.hpp"

#include <CLI/CLI.hpp>
#include <map>
#include <string>

#include "app/config.hpp"

namespace hitchview::app {

CLI::App& AddDemo(CLI::App& app, DemoOptions& options) {
    CLI::App& verb = *app.add_subcommand(
        "demo",
        "Drive the simulated vehicle through the whole pipeline; no hardware needed.\n"
        "Example: hitchview demo --headless --out out/demo");
    verb.add_flag("--headless", options.headless, "open no window");
    verb.add_option("--out", options.out, "folder for recording, videos, picture and report")
        ->capture_default_str();
    verb.add_option("--frames", options.frames, "frame sets, 30 per second")
        ->check(CLI::Range(30, 3000))
        ->capture_default_str();
    verb.add_option("--scenario", options.scenario,
                    "drive by name, see docs/rig.example.yaml; otherwise a slow slalom");
    verb.add_option("--faults", options.faults,
                    "faults of the cameras, by frame, and the drive to them (docs/faults.md)")
        ->check(CLI::ExistingFile);
    verb.add_option("--camera-width", options.camera_width_px,
                    "width of the simulated cameras, 16:9; 640 is enough for the default panorama "
                    "and decodes faster")
        ->check(CLI::IsMember({320, 640, 960, 1280, 1920}))
        ->capture_default_str();
    verb.add_option("--workers", options.workers, "threads that share the work of a frame")
        ->check(CLI::Range(1, kMaxWorkers))
        ->capture_default_str();
    verb.add_flag("--realtime", options.realtime,
                  "one frame set per camera period; late ones are dropped");
    return verb;
}

CLI::App& AddScenarios(CLI::App& app, ScenariosOptions& options) {
    CLI::App& verb = *app.add_subcommand(
        "scenarios",
        "Drive the simulated vehicle through many situations and measure against the truth.\n"
        "Example: hitchview scenarios slalom --lookahead 0,3,5 --offline --cache out/cache");
    verb.add_option("name", options.names, "scenarios to drive; all unless given");
    verb.add_option("--frames", options.run.frames, "stop each after so many frame sets")
        ->check(CLI::Range(1, 36000));
    verb.add_option("--lookahead", options.lookaheads,
                    "frames seen before one is shown; of several (0,3,5) each is driven")
        ->delimiter(',')
        ->check(CLI::Range(0, kMaxLookaheadFrames))
        ->capture_default_str();
    verb.add_flag("--offline", options.offline,
                  "drive once more in the paper's form, which sees all frames before it shows one");
    verb.add_flag("--safety-alone", options.run.safety_alone,
                  "measure only what every frame promises, in a third of the time");
    verb.add_option("--camera-width", options.camera_width_px, "width of the cameras, 16:9")
        ->check(CLI::IsMember({320, 640, 960, 1280, 1920}))
        ->capture_default_str();
    verb.add_option("--canvas-width", options.run.canvas_width_px, "width of the panorama")
        ->check(CLI::IsMember({1024, 2048, 4096}))
        ->capture_default_str();
    verb.add_option("--workers", options.run.workers, "threads that share the work of a frame")
        ->check(CLI::Range(1, kMaxWorkers))
        ->capture_default_str();
    verb.add_option("--out", options.run.out, "folder for panoramas and the worst seams");
    verb.add_option("--cache", options.run.cache,
                    "folder where rendered frames are kept for the next time (1 to 2 GB each)");
    verb.add_option("--json", options.json, "file for all figures");
    return verb;
}

CLI::App& AddBench(CLI::App& app, BenchOptions& options) {
    CLI::App& verb = *app.add_subcommand(
        "bench",
        "Measure what this machine does with eight cameras in memory, beside memcpy and OpenCV.\n"
        "Example: hitchview bench --json bench.json");
    verb.add_option("--workers", options.workers, "threads that share the work of a frame")
        ->check(CLI::Range(1, kMaxWorkers))
        ->capture_default_str();
    verb.add_option("--canvas-width", options.canvas_width_px, "width of the panorama")
        ->check(CLI::IsMember({1024, 2048, 4096}))
        ->capture_default_str();
    verb.add_option("--camera-width", options.camera_width_px, "width of the cameras, 16:9")
        ->check(CLI::IsMember({320, 640, 960, 1280, 1920}))
        ->capture_default_str();
    verb.add_option("--frames", options.frames, "frame sets of each run")
        ->check(CLI::Range(10, 100000))
        ->capture_default_str();
    verb.add_option("--format", options.format, "how the cameras deliver their pixels")
        ->transform(CLI::CheckedTransformer(
            std::map<std::string, hitchview::hal::PixelFormat>{
                {"nv12", hitchview::hal::PixelFormat::kNv12},
                {"uyvy", hitchview::hal::PixelFormat::kUyvy},
                {"yuyv", hitchview::hal::PixelFormat::kYuyv}},
            CLI::ignore_case))
        ->option_text("nv12, uyvy (default) or yuyv");
    verb.add_option("--rounds", options.rounds, "runs of which the median counts")
        ->check(CLI::Range(1, 100))
        ->capture_default_str();
    verb.add_flag("--quick", options.quick,
                  "one round, and no table over cameras, canvas widths and workers");
    verb.add_option("--cache", options.cache, "folder where rendered frames are kept");
    verb.add_option("--record", options.record, "also measure while it records into this folder");
    verb.add_option("--json", options.json, "file for all figures");
    return verb;
}

}  // namespace hitchview::app
