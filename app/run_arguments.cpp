#include "app/run_arguments.hpp"

#include <CLI/CLI.hpp>

namespace hitchview::app {
namespace {

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
    verb.add_option("--faults", options.faults,
                    "faults of the cameras, by frame (docs/faults.md): what is done about them")
        ->check(CLI::ExistingFile);
    verb.add_flag("--metrics", options.metrics,
                  "track the written views again and fill the report's quality figures");
}

}  // namespace

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

CLI::App& AddRun(CLI::App& app, ReplayOptions& options, std::atomic<bool>& trigger) {
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
    return verb;
}

}  // namespace hitchview::app
