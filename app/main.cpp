#include <CLI/CLI.hpp>
#include <atomic>
#include <csignal>
#include <map>
#include <string>
#include <vector>

#include "app/await_verb.hpp"
#include "app/bench_verb.hpp"
#include "app/cameras_verb.hpp"
#include "app/demo_verb.hpp"
#include "app/doctor_verb.hpp"
#include "app/log_arguments.hpp"
#include "app/program.hpp"
#include "app/record_verb.hpp"
#include "app/replay_verb.hpp"
#include "app/scenario_verb.hpp"

namespace {

using namespace hitchview::app;

constexpr int kWrongUse = 2;

std::atomic<bool> stop{false};

void Stop(int) {
    stop = true;
}

std::atomic<bool> trigger{false};

void Trigger(int) {
    trigger = true;
}

void AddRunOptions(CLI::App& verb, ReplayOptions& options) {
    verb.add_option("--rig", options.rig, "rig file (docs/rig.example.yaml shows every key)")
        ->check(CLI::ExistingFile);
    verb.add_option("--out", options.run.out, "folder for report.json and videos");
    verb.add_option("--frames", options.run.frames, "stop after so many frame sets")
        ->check(CLI::Range(1, 1 << 30));
    verb.add_option("--lookahead", options.run.lookahead_frames,
                    "frames seen before one is shown: steadier, later by a period each")
        ->check(CLI::Range(0, kMaxLookaheadFrames));
    verb.add_option("--workers", options.run.workers, "threads that share the work of a frame")
        ->check(CLI::Range(1, kMaxWorkers));
    verb.add_flag("--write-video", options.run.write_video, "write panorama.avi (Motion JPEG)");
    verb.add_flag("--write-views", options.run.write_views,
                  "write tractor.avi and trailer.avi: each view on the canvas before blending");
    verb.add_flag("--trap-alloc", options.run.trap_alloc,
                  "stop at the first heap call after the start and say who made it");
    verb.add_flag("--metrics", options.metrics,
                  "track the written views again and fill the report's quality figures");
}

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

CLI::App& AddReplay(CLI::App& app, ReplayOptions& options) {
    CLI::App& verb = *app.add_subcommand(
        "replay",
        "Make panoramas from recordings, as fast as they can be read.\n"
        "Example: hitchview replay --rig drive/rig.yaml --out out --write-video\n"
        "Example: hitchview replay --log recordings --from 60 --to 90 --out out --write-video");
    AddRunOptions(verb, options);
    verb.add_option("--log", options.logs,
                    "LCM logs, or folders of their segments, in their order: the rig is the "
                    "recorded one, or that of --rig");
    verb.add_option("--from", options.from,
                    "with --log: begin there; seconds since its start, or 2026-11-22T19:51:39.5Z");
    verb.add_option("--to", options.to, "with --log: end there");
    verb.add_flag("--realtime", options.run.realtime,
                  "one frame set per period; late ones are dropped");
    verb.add_option("--speed", options.run.speed,
                    "with --realtime: so many times as fast as it was recorded")
        ->check(CLI::Range(0.1, 10.0))
        ->capture_default_str();
    verb.add_flag("--offline", options.run.offline,
                  "read the recordings twice: steadiest, needs memory for all of them");
    verb.add_option("--coupling", options.coupling,
                    "with --offline: how stitching and stabilisation are joined; literal (as the "
                    "paper states it: stitched, not steadied) or corrected (default)")
        ->check(CLI::IsMember({"literal", "corrected"}));
    verb.add_flag("--publish", options.run.publish, "publish over LCM as the rig file says");
    return verb;
}

void AddRun(CLI::App& app, ReplayOptions& options) {
    CLI::App& verb =
        *app.add_subcommand("run",
                            "Make and publish panoramas at the cameras' pace until stopped.\n"
                            "Example: hitchview run --rig /etc/hitchview/rig.yaml");
    AddRunOptions(verb, options);
    verb.get_option("--rig")->required();
    options.run.realtime = true;
    options.run.publish = true;
    options.run.record = true;
    options.run.trigger = &trigger;
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

CLI::App& AddCameras(CLI::App& app, CamerasOptions& options) {
    CLI::App& verb = *app.add_subcommand(
        "cameras",
        "List the cameras of this machine, what would be picked of each and why.\n"
        "Example: hitchview cameras --rig /etc/hitchview/rig.yaml");
    verb.add_option("--rig", options.rig, "rig file whose cameras are looked for; 1: some missing")
        ->check(CLI::ExistingFile);
    verb.add_flag("--all", options.all, "every format, size and rate that is offered");
    verb.add_flag("--measure", options.measure,
                  "stream from each free device for a moment to measure how fast its memory reads");
    verb.add_option("--json", options.json, "file for everything");
    return verb;
}

CLI::App& AddDoctor(CLI::App& app, DoctorOptions& options) {
    CLI::App& verb = *app.add_subcommand("doctor",
                                         "Is this machine ready? Each failure with what puts it "
                                         "right; changes nothing. Exit code: 0 it is, 1 it is not, "
                                         "2 the given rig file is bad, 3 nothing can be told.\n"
                                         "Example: hitchview doctor\n"
                                         "Example: hitchview doctor --rig new.yaml --json");
    verb.add_option("--rig", options.rig,
                    "rig file whose needs are checked (default: /etc/hitchview/rig.yaml, where "
                    "there is one)")
        ->check(CLI::ExistingFile);
    verb.add_flag("--json", options.json, "print JSON instead of a table");
    return verb;
}

/// Hands the arguments behind a verb to the program that does it.
int Forward(const char* program, int argc, char** argv) {
    return RunProgram(SiblingProgram(program), std::vector<std::string>(argv + 2, argv + argc));
}

/// The same for one that runs until a signal comes.
int Become(const char* program, int argc, char** argv) {
    return BecomeProgram(SiblingProgram(program), std::vector<std::string>(argv + 2, argv + argc));
}

}  // namespace

int main(int argc, char** argv) {
    std::signal(SIGINT, Stop);
    std::signal(SIGTERM, Stop);
    std::signal(SIGUSR1, Trigger);
    const std::string verb = argc > 1 ? argv[1] : "";
    if (verb == "view") return Forward("hitchview-view", argc, argv);
    if (verb == "eval") return Forward("hitchview-eval", argc, argv);
    if (verb == "web") return Become("hitchview-web", argc, argv);

    CLI::App app{"Hitchview: one steady 360-degree panorama from the cameras of a tractor-trailer"};
    app.set_version_flag("--version", HITCHVIEW_VERSION);
    app.require_subcommand(1);

    DemoOptions demo;
    const CLI::App& demo_verb = AddDemo(app, demo);
    ReplayOptions replay;
    const CLI::App& replay_verb = AddReplay(app, replay);
    ReplayOptions run;
    AddRun(app, run);
    RecordOptions record;
    const CLI::App& record_verb = AddRecord(app, record);
    ScenariosOptions scenarios;
    const CLI::App& scenarios_verb = AddScenarios(app, scenarios);
    BenchOptions bench;
    const CLI::App& bench_verb = AddBench(app, bench);
    AwaitOptions await;
    const CLI::App& await_verb = AddAwait(app, await);
    CamerasOptions cameras;
    const CLI::App& cameras_verb = AddCameras(app, cameras);
    DoctorOptions doctor;
    const CLI::App& doctor_verb = AddDoctor(app, doctor);
    CheckOptions check;
    const CLI::App& check_verb = AddCheck(app, check);
    ExportOptions exporting;
    const CLI::App& export_verb = AddExport(app, exporting);
    app.add_subcommand("view", "Show the published panorama: hitchview view --help");
    app.add_subcommand("eval", "Measure recordings of views and panoramas: hitchview eval --help");
    app.add_subcommand("web", "Show a running rig in a browser: hitchview web --help");

    try {
        app.parse(argc, argv);
    } catch (const CLI::ParseError& error) {
        return app.exit(error) == 0 ? 0 : kWrongUse;
    }
    if (demo_verb.parsed()) return DemoVerb(demo, stop);
    if (replay_verb.parsed()) return ReplayVerb(replay, stop);
    if (record_verb.parsed()) return RecordVerb(record, stop, trigger);
    if (scenarios_verb.parsed()) return ScenariosVerb(scenarios, stop);
    if (bench_verb.parsed()) return BenchVerb(bench, stop);
    if (await_verb.parsed()) return AwaitVerb(await, stop);
    if (cameras_verb.parsed()) return CamerasVerb(cameras);
    if (doctor_verb.parsed()) return DoctorVerb(doctor);
    if (check_verb.parsed()) return CheckVerb(check, stop);
    if (export_verb.parsed()) return ExportVerb(exporting, stop);
    return ReplayVerb(run, stop);
}
