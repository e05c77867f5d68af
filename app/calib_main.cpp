#include <CLI/CLI.hpp>
#include <algorithm>
#include <atomic>
#include <csignal>
#include <functional>
#include <string>
#include <vector>

#include "app/calib_capture_verb.hpp"
#include "app/calib_formats_arguments.hpp"
#include "app/calib_hitch_verb.hpp"
#include "app/calib_intrinsics_verb.hpp"
#include "app/calib_report_verb.hpp"
#include "app/calib_target_verb.hpp"
#include "app/calib_unit_verb.hpp"
#include "app/calib_verify_verb.hpp"
#include "app/exit_code.hpp"

namespace {

using namespace hitchview::app;

std::atomic<bool> stop{false};
void Stop(int) {
    stop = true;
}

std::string CommandLine(int argc, char** argv) {
    std::string line = "hitchview-calib " HITCHVIEW_VERSION;
    for (int i = 1; i < argc; ++i) line.append(" ").append(argv[i]);
    return line;
}

/// What is done when its subcommand is given.
struct Verb {
    const CLI::App& subcommand;
    std::function<int()> run;
};

}  // namespace

int main(int argc, char** argv) {
    CLI::App app{"Hitchview's field calibration: measure cameras and rig, and judge the result"};
    app.set_version_flag("--version", HITCHVIEW_VERSION);
    app.require_subcommand(1);
    TargetOptions target;
    CaptureOptions capture{.stop = &stop};
    IntrinsicsOptions intrinsics;
    UnitOptions unit;
    HitchOptions hitch;
    VerifyOptions verify;
    CalibReportOptions report;
    CalibImportOptions imported;
    CalibExportOptions exported;
    for (std::string* command :
         {&capture.command, &intrinsics.command, &unit.command, &hitch.command, &verify.command,
          &report.command, &imported.command})
        *command = CommandLine(argc, argv);
    const std::vector<Verb> verbs{
        {AddTarget(app, target), [&] { return TargetVerb(target); }},
        {AddCapture(app, capture),
         [&] {
             std::signal(SIGINT, Stop);
             return CaptureVerb(capture);
         }},
        {AddIntrinsics(app, intrinsics), [&] { return IntrinsicsVerb(intrinsics); }},
        {AddUnit(app, unit), [&] { return UnitVerb(unit); }},
        {AddHitch(app, hitch), [&] { return HitchVerb(hitch); }},
        {AddVerify(app, verify), [&] { return VerifyVerb(verify); }},
        {AddCalibReport(app, report), [&] { return CalibReportVerb(report); }},
        {AddCalibImport(app, imported), [&] { return CalibImportVerb(imported); }},
        {AddCalibExport(app, exported), [&] { return CalibExportVerb(exported); }},
    };
    try {
        app.parse(argc, argv);
    } catch (const CLI::ParseError& error) {
        return app.exit(error) == 0 ? 0 : kWrongUse;
    }
    const auto given =
        std::ranges::find_if(verbs, [](const Verb& verb) { return verb.subcommand.parsed(); });
    return given->run();
}
