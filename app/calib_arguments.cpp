#include "app/calib_arguments.hpp"

#include <map>

namespace hitchview::app {

using Kind = algo::CameraModel::Kind;

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

CLI::App& AddReport(CLI::App& app, CalibReportOptions& options) {
    CLI::App& verb = *app.add_subcommand(
        "report",
        "Make one page of the figures that other verbs have written with --json.\n"
        "Example: hitchview-calib report --json front.json rear.json tractor.json --out "
        "report.html");
    verb.add_option("--json", options.json, "files of intrinsics, unit, verify")->required();
    verb.add_option("--out", options.out, "HTML page to write")->required();
    return verb;
}

}  // namespace hitchview::app
