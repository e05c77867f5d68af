#include <CLI/CLI.hpp>
#include <algorithm>
#include <cstdio>
#include <filesystem>
#include <string>
#include <vector>

#include "app/await_verb.hpp"
#include "app/cameras_verb.hpp"
#include "app/doctor_verb.hpp"
#include "app/exit_code.hpp"
#include "app/log_arguments.hpp"
#include "app/program.hpp"
#include "app/record_verb.hpp"
#include "app/run_arguments.hpp"
#include "app/signals.hpp"

// The program on the road. What it loads is resident on the vehicle's computer and read before its
// first panorama, so verbs that need libraries for windows, videos, pictures or HTTP are programs
// of their own.
namespace {

using namespace hitchview::app;

/// A verb of another program.
struct Forwarded {
    const char* verb;
    const char* program;
    bool tells_verb;  ///< the program has several
    const char* description;
};

constexpr Forwarded kForwarded[] = {
    {"demo", "hitchview-desk", true, "Drive the simulated vehicle through the whole pipeline"},
    {"replay", "hitchview-desk", true, "Make panoramas from recordings"},
    {"export", "hitchview-desk", true, "Turn recordings into what other programs read"},
    {"scenarios", "hitchview-desk", true, "Measure simulated drives against the truth"},
    {"bench", "hitchview-desk", true, "Measure what this machine does"},
    {"view", "hitchview-view", false, "Show the published panorama"},
    {"eval", "hitchview-eval", false, "Measure recordings of views and panoramas"},
    {"web", "hitchview-web", false, "Show a running rig in a browser"}};

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

/// Becomes the program that does it: signals are then the program's.
int Become(const std::string& program, const std::vector<std::string>& arguments) {
    const std::filesystem::path path = SiblingProgram(program);
    BecomeProgram(path, arguments);
    return Fail(kMachineFailed, path.string() + ": cannot be started; it is in hitchview-tools");
}

/// Whether its cameras are video files or pictures, which the desk's program reads.
bool NeedsDesk(const std::filesystem::path& rig) {
    auto config = LoadRigConfig(rig);
    if (!config) return false;  // the verb itself says what is wrong
    for (const hitchview::algo::Unit unit : hitchview::algo::kUnits) {
        if (std::ranges::any_of(config->units[unit].cameras, &CameraConfig::ReadsPictures))
            return true;
    }
    return false;
}

}  // namespace

int main(int argc, char** argv) {
    const std::vector<std::string> arguments(argv + 1, argv + argc);
    for (const Forwarded& other : kForwarded) {
        if (arguments.empty() || arguments[0] != other.verb) continue;
        const auto first = arguments.begin() + (other.tells_verb ? 0 : 1);
        return Become(other.program, {first, arguments.end()});
    }
    CatchSignals();

    CLI::App app{"Hitchview: one steady 360-degree panorama from the cameras of a tractor-trailer"};
    app.set_version_flag("--version", HITCHVIEW_VERSION);
    app.require_subcommand(1);

    ReplayOptions run;
    const CLI::App& run_verb = AddRun(app, run, trigger_asked);
    RecordOptions record;
    const CLI::App& record_verb = AddRecord(app, record);
    AwaitOptions await;
    const CLI::App& await_verb = AddAwait(app, await);
    CamerasOptions cameras;
    const CLI::App& cameras_verb = AddCameras(app, cameras);
    DoctorOptions doctor;
    const CLI::App& doctor_verb = AddDoctor(app, doctor);
    CheckOptions check;
    AddCheck(app, check);
    for (const Forwarded& other : kForwarded) {
        app.add_subcommand(
            other.verb, std::string(other.description) + ": hitchview " + other.verb + " --help");
    }

    try {
        app.parse(argc, argv);
    } catch (const CLI::ParseError& error) {
        return app.exit(error) == 0 ? kGood : kWrongUse;
    }
    if (run_verb.parsed()) {
        if (NeedsDesk(run.rig)) return Become("hitchview-desk", arguments);
        return ReplayVerb(run, stop_asked);
    }
    if (record_verb.parsed()) {
        if (!record.rig.empty() && NeedsDesk(record.rig))
            return Become("hitchview-desk", arguments);
        return RecordVerb(record, stop_asked, trigger_asked);
    }
    if (await_verb.parsed()) return AwaitVerb(await, stop_asked);
    if (cameras_verb.parsed()) return CamerasVerb(cameras);
    if (doctor_verb.parsed()) return DoctorVerb(doctor);
    return CheckVerb(check, stop_asked);
}
