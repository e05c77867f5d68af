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
        "Example: hitchview check /var/lib/hitchview/recordings --json check.json\n"
        "Example: hitchview check torn.lcm --repair whole.lcm");
    AddLogs(verb, options.logs);
    verb.add_option("--json", options.json, "file for all figures");
    verb.add_option("--repair", options.repair,
                    "new log for every whole event, numbered anew; says what was left out");
    return verb;
}

}  // namespace hitchview::app
