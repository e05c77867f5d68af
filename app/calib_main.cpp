#include <CLI/CLI.hpp>
#include <map>
#include <string>

#include "app/calib_formats_arguments.hpp"
#include "app/calib_intrinsics_verb.hpp"
#include "app/calib_report_verb.hpp"
#include "app/calib_unit_verb.hpp"

namespace {

using namespace hitchview::app;
using Kind = hitchview::algo::CameraModel::Kind;

constexpr int kWrongUse = 2;

std::string CommandLine(int argc, char** argv) {
    std::string line = "hitchview-calib " HITCHVIEW_VERSION;
    for (int i = 1; i < argc; ++i) line.append(" ").append(argv[i]);
    return line;
}

CLI::App& AddIntrinsics(CLI::App& app, IntrinsicsOptions& options) {
    CLI::App& verb =
        *app.add_subcommand("intrinsics",
                            "Measure a lens from pictures of a chessboard, and judge the result.\n"
                            "Exit code 0: it may be driven with, 1: not, and why.\n"
                            "Example: hitchview-calib intrinsics --images 'front/*.jpg' --board "
                            "9x6,0.025 --model fisheye "
                            "--out front.yaml");
    auto* const source = verb.add_option_group("pictures");
    source->add_option("--images", options.images, "pictures of one camera, a pattern in quotes");
    source->add_option("--folder", options.folder,
                       "a folder of pictures for each camera, named as the camera is");
    source->require_option(1);
    verb.add_option("--board", options.board,
                    "COLSxROWS,SQUARE_M: inner corners, side of a square in metres")
        ->required();
    verb.add_option("--model", options.model, "pinhole, or fisheye for 120 degrees and more")
        ->transform(CLI::CheckedTransformer(std::map<std::string, Kind>{
            {"pinhole", Kind::kPinholeRadtan}, {"fisheye", Kind::kKannalaBrandt4}}))
        ->required();
    verb.add_option(
        "--out", options.out,
        "lens file to write, with the verdict in it; with --folder the folder of the files");
    verb.add_flag("--keep-failed", options.keeps_failed,
                  "write the lens file also when the verdict is fail");
    verb.add_option("--json", options.json, "file for all figures");
    return verb;
}

}  // namespace

int main(int argc, char** argv) {
    CLI::App app{"Hitchview's field calibration: measure cameras and rig, and judge the result"};
    app.set_version_flag("--version", HITCHVIEW_VERSION);
    app.require_subcommand(1);
    IntrinsicsOptions intrinsics;
    AddIntrinsics(app, intrinsics);
    CalibImportOptions imported;
    const CLI::App& import_verb = AddCalibImport(app, imported);
    CalibExportOptions exported;
    const CLI::App& export_verb = AddCalibExport(app, exported);
    CalibReportOptions report;
    const CLI::App& report_verb = AddCalibReport(app, report);
    UnitOptions unit;
    const CLI::App& unit_verb = AddUnit(app, unit);
    try {
        app.parse(argc, argv);
    } catch (const CLI::ParseError& error) {
        return app.exit(error) == 0 ? 0 : kWrongUse;
    }
    intrinsics.command = imported.command = report.command = unit.command = CommandLine(argc, argv);
    if (import_verb.parsed()) return CalibImportVerb(imported);
    if (export_verb.parsed()) return CalibExportVerb(exported);
    if (report_verb.parsed()) return CalibReportVerb(report);
    if (unit_verb.parsed()) return UnitVerb(unit);
    return IntrinsicsVerb(intrinsics);
}
