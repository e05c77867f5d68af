#include "app/calib_formats_arguments.hpp"

#include <charconv>
#include <map>

namespace hitchview::app {
namespace {

using Kind = algo::CameraModel::Kind;

const std::map<std::string, calib::Format> kFormats{{"opencv", calib::Format::kOpenCv},
                                                    {"ros", calib::Format::kRos},
                                                    {"kalibr", calib::Format::kKalibr},
                                                    {"mrcal", calib::Format::kMrcal}};

void AddFormat(CLI::App& verb, calib::Format& format) {
    verb.add_option("--format", format, "opencv, ros, kalibr or mrcal")
        ->transform(CLI::CheckedTransformer(kFormats))
        ->required();
}

/// `WxH`; false: it is not.
bool ReadSize(const std::string& text, std::array<int, 2>& size_px) {
    const char* const end = text.data() + text.size();
    const auto width = std::from_chars(text.data(), end, size_px[0]);
    if (width.ec != std::errc{} || width.ptr == end || *width.ptr != 'x') return false;
    const auto height = std::from_chars(width.ptr + 1, end, size_px[1]);
    return height.ec == std::errc{} && height.ptr == end && size_px[0] >= 64 && size_px[1] >= 64 &&
           size_px[0] <= 8192 && size_px[1] <= 8192;
}

void AddHints(CLI::App& verb, calib::ImportHints& hints) {
    verb.add_option_function<Kind>(
            "--model", [&hints](const Kind& kind) { hints.kind = kind; },
            "pinhole or fisheye, where the file does not say")
        ->transform(CLI::CheckedTransformer(std::map<std::string, Kind>{
            {"pinhole", Kind::kPinholeRadtan}, {"fisheye", Kind::kKannalaBrandt4}}));
    verb.add_option_function<std::string>(
        "--size",
        [&hints](const std::string& text) {
            hints.size_px.emplace();
            if (!ReadSize(text, *hints.size_px))
                throw CLI::ValidationError("--size", "is " + text + ", must be as 1280x720");
        },
        "WIDTHxHEIGHT of the picture, where the file does not say");
}

}  // namespace

CLI::App& AddCalibImport(CLI::App& app, CalibImportOptions& options) {
    CLI::App& verb =
        *app.add_subcommand("import",
                            "Make a lens file, or with --unit a rig calibration, of files of "
                            "OpenCV, ROS, kalibr or mrcal.\n"
                            "The verdict is 'unchecked': measure before you drive.\n"
                            "Example: hitchview-calib import --format ros --in front.yaml --out "
                            "front.lens.yaml");
    AddFormat(verb, options.format);
    verb.add_option("--in", options.in, "files to read")->required();
    verb.add_option("--out", options.out, "lens file or rig calibration to write")->required();
    AddHints(verb, options.hints);
    verb.add_option("--camera", options.camera, "take this one of several in a file");
    verb.add_option("--unit", options.units,
                    "tractor or trailer, which carries the cameras: one for all files or one for "
                    "each; takes their places, too");
    verb.add_option("--vehicle", options.vehicle, "name of the vehicle in a rig calibration");
    verb.add_option("--first-camera", options.first_camera,
                    "X,Y,Z,ROLL,PITCH,YAW of the first camera in its unit, metres and degrees: "
                    "where the files tell places to each other only");
    return verb;
}

CLI::App& AddCalibExport(CLI::App& app, CalibExportOptions& options) {
    CLI::App& verb =
        *app.add_subcommand("export",
                            "Write a rig calibration or a lens as OpenCV, ROS, kalibr or mrcal "
                            "read it.\n"
                            "Example: hitchview-calib export --format mrcal --calibration "
                            "rig.calib.yaml --out mrcal/");
    AddFormat(verb, options.format);
    verb.add_option("--calibration", options.calibration, "whole rig to read");
    verb.add_option("--lens", options.lens, "lens file to read");
    verb.add_option("--out", options.out,
                    "folder for a file of each camera (kalibr: of each unit); of a lens the file")
        ->required();
    return verb;
}

}  // namespace hitchview::app
