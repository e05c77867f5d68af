#include <CLI/CLI.hpp>

#include "app/config.hpp"
#include "app/record_verb.hpp"

namespace hitchview::app {
namespace {

constexpr int kMostMegabytes = 10'000'000;

void AddSource(CLI::App& verb, RecordOptions& options) {
    CLI::Option_group& source = *verb.add_option_group("source", "one of them");
    source.add_option("--board", options.board, "sim: the simulated vehicle, no hardware needed")
        ->check(CLI::IsMember({"sim"}));
    source.add_option("--rig", options.rig, "rig file (docs/rig.example.yaml shows every key)")
        ->check(CLI::ExistingFile);
    source.require_option(1);
    verb.add_option("--scenario", options.scenario, "drive of the simulated vehicle, by name")
        ->capture_default_str();
    verb.add_option("--camera-width", options.camera_width_px,
                    "width of the simulated cameras, 16:9")
        ->check(CLI::IsMember({320, 640, 960, 1280, 1920}))
        ->capture_default_str();
    verb.add_option("--loop-frames", options.loop_frames,
                    "of the simulated vehicle: render the first so many frames only, show them "
                    "forth and back")
        ->check(CLI::Range(2, 600));
    verb.add_flag("--live", options.live,
                  "of the simulated vehicle: cameras that run at their own pace, without an end "
                  "(30 looped frames, unless given); rig.yaml is then for `run`, too");
}

void AddLimits(CLI::App& verb, RecordOptions& options) {
    verb.add_option("--segment-seconds", options.segment_s, "length of a file")
        ->check(CLI::Range(1, 3600));
    verb.add_option("--quota-mb", options.quota_mb,
                    "the oldest recordings in the folder go when all have more; 0: never")
        ->check(CLI::Range(0, kMostMegabytes));
    verb.add_option("--min-free-mb", options.min_free_mb,
                    "recording stops when the disk has less left; panoramas go on")
        ->check(CLI::Range(0, kMostMegabytes));
    verb.add_option("--pre-trigger", options.pre_trigger_s,
                    "keep the last so many seconds in memory and write nothing until SIGUSR1, or "
                    "record.trigger")
        ->check(CLI::Range(0, 600));
    verb.add_option("--after-trigger", options.after_trigger_s,
                    "with --pre-trigger: seconds from the trigger to the end; 0: for ever")
        ->check(CLI::Range(0, 86'400));
    verb.add_option("--memory-mb", options.memory_mb, "memory for what waits to be written")
        ->check(CLI::Range(8, 16'384));
}

void AddFrames(CLI::App& verb, RecordOptions& options) {
    verb.add_option("--format", options.format, "of the cameras' frames: jpeg (default) or raw")
        ->check(CLI::IsMember({"jpeg", "raw"}));
    verb.add_option("--quality", options.quality, "of JPEG")->check(CLI::Range(30, 100));
    verb.add_option("--every", options.every, "record each so many-th frame of the cameras")
        ->check(CLI::Range(1, 1000));
}

}  // namespace

CLI::App& AddRecord(CLI::App& app, RecordOptions& options) {
    CLI::App& verb = *app.add_subcommand(
        "record",
        "Record cameras, CAN bus and panoramas into LCM logs, beside making the panoramas.\n"
        "What is given here stands in place of the rig file's section `record`.\n"
        "Example: hitchview record --board sim --out out/drive --seconds 10\n"
        "Example: hitchview record --board sim --live --out out/live --seconds 60\n"
        "Example: hitchview record --rig /etc/hitchview/rig.yaml --out /var/lib/hitchview/drives");
    AddSource(verb, options);
    verb.add_option("--out", options.out, "folder for the recording and report.json")->required();
    verb.add_option("--seconds", options.seconds,
                    "length: of time, or of the drive where it is recorded or simulated; default: "
                    "until stopped, the end of the recording, 10 of the simulated vehicle unless "
                    "live")
        ->check(CLI::Range(0.1, 1e6));
    AddLimits(verb, options);
    AddFrames(verb, options);
    verb.add_option("--workers", options.workers, "threads that share the work of a frame")
        ->check(CLI::Range(1, kMaxWorkers));
    verb.add_flag("--trap-alloc", options.trap_alloc,
                  "stop at the first heap call after the start and say who made it");
    return verb;
}

}  // namespace hitchview::app
