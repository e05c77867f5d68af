#include "calib/format_ros.hpp"

#include <array>

namespace hitchview::calib {
namespace {

using algo::CameraModel;
using Kind = CameraModel::Kind;

constexpr std::array kModels{Choice<Kind>{"plumb_bob", Kind::kPinholeRadtan},
                             Choice<Kind>{"rational_polynomial", Kind::kPinholeRadtan},
                             Choice<Kind>{"equidistant", Kind::kKannalaBrandt4}};

std::string Matrix(const std::string& name, int rows, int columns,
                   const std::vector<double>& numbers) {
    return name + ":\n  rows: " + std::to_string(rows) + "\n  cols: " + std::to_string(columns) +
           "\n  data: " + ListText(numbers) + "\n";
}

}  // namespace

std::vector<ForeignCamera> ReadRos(YamlMap& root, const ImportHints& hints,
                                   const std::string& name) {
    constexpr Range<int> kSize{64, 8192};
    ForeignCamera camera{.name = name};
    CameraModel& model = camera.model;
    const YamlValue kind = root.Required("distortion_model");
    kind.Read(kModels, model.kind);
    if (hints.kind && model.kind != *hints.kind)
        kind.Refuse("as --model says, " + std::string(ToString(*hints.kind)));
    const YamlValue width = FirstOf(root, {"image_width", "width"});
    width.Read(kSize, model.width_px);
    FirstOf(root, {"image_height", "height"}).Read(kSize, model.height_px);
    CheckSize(width, hints, model);
    ReadCameraMatrix(FirstOf(root, {"camera_matrix", "K", "k"}), model);
    const YamlValue distortion = FirstOf(root, {"distortion_coefficients", "D", "d"});
    ReadCoefficients(distortion, model);
    CompleteField(distortion, model);
    if (const YamlValue given = root["camera_name"]; given.given()) {
        std::string text;
        given.Read(text);
        camera.name = AsName(text, name);
    }
    return {camera};
}

std::string RosText(const std::string& name, const CameraModel& m) {
    const std::vector<double> coefficients = Coefficients(m);
    const char* const model = m.kind == Kind::kPinholeRadtan ? "plumb_bob" : "equidistant";
    return "image_width: " + std::to_string(m.width_px) +
           "\nimage_height: " + std::to_string(m.height_px) + "\ncamera_name: " + QuotedText(name) +
           "\n" +
           Matrix("camera_matrix", 3, 3, {m.fx_px, 0, m.cx_px, 0, m.fy_px, m.cy_px, 0, 0, 1}) +
           "distortion_model: " + model + "\n" +
           Matrix("distortion_coefficients", 1, static_cast<int>(coefficients.size()),
                  coefficients) +
           Matrix("rectification_matrix", 3, 3, {1, 0, 0, 0, 1, 0, 0, 0, 1}) +
           Matrix("projection_matrix", 3, 4,
                  {m.fx_px, 0, m.cx_px, 0, 0, m.fy_px, m.cy_px, 0, 0, 0, 1, 0});
}

}  // namespace hitchview::calib
