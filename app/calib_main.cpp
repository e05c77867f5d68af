#include <CLI/CLI.hpp>
#include <atomic>
#include <csignal>
#include <map>
#include <string>

#include "app/calib_capture_verb.hpp"
#include "app/calib_intrinsics_verb.hpp"
#include "app/calib_target_verb.hpp"

namespace {

using namespace hitchview::app;
using Kind = hitchview::algo::CameraModel::Kind;

constexpr int kWrongUse = 2;

std::atomic<bool> stop{false};
void Stop(int) {
    stop = true;
}

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
    verb.add_option("--images", options.images, "pictures of one camera, a pattern in quotes")
        ->required();
    verb.add_option("--board", options.board,
                    "COLSxROWS,SQUARE_M: inner corners, side of a square in metres")
        ->required();
    verb.add_option("--model", options.model, "pinhole, or fisheye for 120 degrees and more")
        ->transform(CLI::CheckedTransformer(std::map<std::string, Kind>{
            {"pinhole", Kind::kPinholeRadtan}, {"fisheye", Kind::kKannalaBrandt4}}))
        ->required();
    verb.add_option("--out", options.out, "lens file to write, with the verdict in it");
    verb.add_option("--json", options.json, "file for all figures");
    return verb;
}

CLI::App& AddTarget(CLI::App& app, TargetOptions& options) {
    using hitchview::calib::Pattern;
    CLI::App& verb = *app.add_subcommand(
        "target",
        "Print a board: a sheet at its exact size, with a bar to measure after printing.\n"
        "What is not given is chosen so that the paper is filled.\n"
        "Example: hitchview-calib target --pattern charuco --paper a2 --out sheet.pdf "
        "--board-out board.yaml");
    SheetRequest& sheet = options.sheet;
    verb.add_option("--pattern", sheet.pattern, "checkerboard, charuco or tags (charuco)")
        ->transform(CLI::CheckedTransformer(
            std::map<std::string, Pattern>{{"checkerboard", Pattern::kCheckerboard},
                                           {"charuco", Pattern::kCharuco},
                                           {"tags", Pattern::kTags}}));
    verb.add_option("--columns", sheet.columns, "inner corners in a row, or tags");
    verb.add_option("--rows", sheet.rows, "inner corners in a column, or tags");
    verb.add_option("--square-m", sheet.square_m, "side of a square; from tag to tag");
    verb.add_option("--tag-m", sheet.tag_m, "side of a tag's black frame");
    verb.add_option("--first-tag", sheet.first_tag, "number of the first tag (0)");
    verb.add_option("--paper", sheet.paper, "a4 to a0, or WIDTHxHEIGHT in mm (a4)");
    verb.add_option("--out", options.out, "sheet to write, .pdf or .svg")->required();
    verb.add_option("--board-out", options.board_out, "board file to write, for --board");
    return verb;
}

CLI::App& AddCapture(CLI::App& app, CaptureOptions& options) {
    CLI::App& verb = *app.add_subcommand(
        "capture",
        "Choose pictures of a board that is held before the cameras, and say what to do next.\n"
        "Exit code 0: every camera has enough, 1: not, and what is missing.\n"
        "Example: hitchview-calib capture --rig rig.yaml --board board.yaml --out pictures");
    verb.add_option("--board", options.board, "board file, or COLSxROWS,SQUARE_M")->required();
    verb.add_option("--rig", options.rig, "rig file: all its cameras at once");
    verb.add_option("--video", options.video, "a film of one camera");
    verb.add_option("--images", options.images, "pictures of one camera, a pattern in quotes");
    verb.add_option("--log", options.log, "a recording (LCM log): its camera --camera");
    verb.add_option("--camera", options.camera, "its name; with --rig, this camera only");
    verb.add_option("--views", options.views, "of each camera, at least (20)")
        ->check(CLI::Range(6, 200));
    verb.add_option("--out", options.out, "folder for a new folder of each camera")->required();
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
    CaptureOptions capture;
    const CLI::App& capture_verb = AddCapture(app, capture);
    TargetOptions target;
    const CLI::App& target_verb = AddTarget(app, target);
    try {
        app.parse(argc, argv);
    } catch (const CLI::ParseError& error) {
        return app.exit(error) == 0 ? 0 : kWrongUse;
    }
    if (capture_verb.parsed()) {
        std::signal(SIGINT, Stop);
        capture.stop = &stop;
        return CaptureVerb(capture);
    }
    if (target_verb.parsed()) return TargetVerb(target);
    intrinsics.command = CommandLine(argc, argv);
    return IntrinsicsVerb(intrinsics);
}
