#include "app/log_arguments.hpp"

#include <CLI/CLI.hpp>

namespace hitchview::app {
namespace {

void AddLogs(CLI::App& verb, std::vector<std::filesystem::path>& logs) {
    verb.add_option("LOG", logs, "log files, or folders of them, in their order")->required();
}

}  // namespace

CLI::App& AddCheck(CLI::App& app, CheckOptions& options) {
    CLI::App& verb = *app.add_subcommand(
        "check",
        "Tell whether a recording is good: what is missing, damaged or out of step.\n"
        "Exit code 0: good, 1: bad, 2: not readable.\n"
        "Example: hitchview check /var/lib/hitchview/recordings --json\n"
        "Example: hitchview check torn.lcm --repair whole.lcm");
    AddLogs(verb, options.logs);
    verb.add_flag("--json", options.json, "print all figures as JSON instead of the table");
    verb.add_option("--repair", options.repair,
                    "new log for every whole event, numbered anew; says what was left out");
    return verb;
}

CLI::App& AddExport(CLI::App& app, ExportOptions& options) {
    CLI::App& verb = *app.add_subcommand(
        "export",
        "Write a recording in a format of other programs.\n"
        "Example: hitchview export recordings --mp4 panorama.mp4\n"
        "Example: hitchview export drive.lcm --frames pictures --camera tractor_front\n"
        "Example: hitchview export drive.lcm --mcap drive.mcap");
    AddLogs(verb, options.logs);
    CLI::Option_group& formats = *verb.add_option_group("output", "one of them");
    formats.add_option("--mp4", options.mp4, "video (H.264); needs the program ffmpeg");
    formats.add_option("--frames", options.frames, "folder for PNG files");
    formats.add_option("--candump", options.candump, "CAN frames as candump -L writes them");
    formats.add_option("--mcap", options.mcap, "everything, for Foxglove and other players");
    formats.add_option("--csv", options.csv, "status of every panorama as a table");
    formats.require_option(1);
    verb.add_option("--camera", options.camera,
                    "pictures of this camera instead of the panorama; with --mcap: of the pictures "
                    "only its");
    return verb;
}

}  // namespace hitchview::app
