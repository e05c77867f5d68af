#include "calib/format_opencv.hpp"

#include <array>

namespace hitchview::calib {
namespace {

using algo::CameraModel;
using Kind = CameraModel::Kind;

constexpr std::array kModels{Choice<Kind>{"pinhole", Kind::kPinholeRadtan},
                             Choice<Kind>{"plumb_bob", Kind::kPinholeRadtan},
                             Choice<Kind>{"radtan", Kind::kPinholeRadtan},
                             Choice<Kind>{"pinhole_radtan", Kind::kPinholeRadtan},
                             Choice<Kind>{"rational_polynomial", Kind::kPinholeRadtan},
                             Choice<Kind>{"fisheye", Kind::kKannalaBrandt4},
                             Choice<Kind>{"equidistant", Kind::kKannalaBrandt4},
                             Choice<Kind>{"kannala_brandt", Kind::kKannalaBrandt4},
                             Choice<Kind>{"kannala_brandt4", Kind::kKannalaBrandt4}};

constexpr std::array kFlags{
    Choice<Kind>{"0", Kind::kPinholeRadtan}, Choice<Kind>{"false", Kind::kPinholeRadtan},
    Choice<Kind>{"1", Kind::kKannalaBrandt4}, Choice<Kind>{"true", Kind::kKannalaBrandt4}};

/// What the file calls the lens; empty: it does not say.
std::optional<Kind> NamedKind(YamlMap& root, const ImportHints& hints) {
    const YamlValue word = FirstOf(root, {"model", "distortion_model", "camera_model"});
    const YamlValue flag = FirstOf(root, {"fisheye_model", "isFisheye", "is_fisheye"});
    if (!word.given() && !flag.given()) return std::nullopt;
    Kind kind = hints.kind.value_or(Kind::kPinholeRadtan);
    word.given() ? word.Read(kModels, kind) : flag.Read(kFlags, kind);
    if (hints.kind && kind != *hints.kind)
        (word.given() ? word : flag)
            .Refuse("as --model says, " + std::string(ToString(*hints.kind)));
    return kind;
}

/// Where nothing names the lens, more than four coefficients do.
Kind KindOf(YamlMap& root, const YamlValue& distortion, std::size_t coefficients,
            const ImportHints& hints) {
    if (const auto named = NamedKind(root, hints)) return *named;
    if (hints.kind) return *hints.kind;
    if (coefficients == 4)
        distortion.Refuse(
            "told apart: four may be a pinhole's k1 k2 p1 p2 or a fisheye's k1 k2 k3 k4; say "
            "--model pinhole or --model fisheye");
    return Kind::kPinholeRadtan;
}

CameraModel ReadOpenCvSize(YamlMap& root, const ImportHints& hints) {
    CameraModel model;
    constexpr Range<int> kSize{64, 8192};
    const YamlValue pair =
        FirstOf(root, {"image_size", "resolution", "cameraResolution", "imageSize", "size"});
    const YamlValue width = FirstOf(root, {"image_width", "image_Width", "width"});
    const YamlValue height = FirstOf(root, {"image_height", "image_Height", "height"});
    if (pair.given()) {
        ReadSize(pair, model);
        CheckSize(pair, hints, model);
    } else if (!width.given() && !height.given()) {
        if (!hints.size_px) width.RefuseOrMiss("given, or told with --size");
        const auto [width_px, height_px] = hints.size_px.value_or(std::array{0, 0});
        model.width_px = width_px;
        model.height_px = height_px;
    } else {
        width.Read(kSize, model.width_px);
        height.Read(kSize, model.height_px);
        CheckSize(width, hints, model);
    }
    return model;
}

/// `model` has the picture's size.
CameraModel ReadLens(CameraModel model, YamlMap& root, const YamlValue& matrix,
                     const YamlValue& distortion, const ImportHints& hints) {
    const auto coefficients = ReadNumbers(distortion, {0, 14});
    model.kind = KindOf(root, distortion, coefficients ? coefficients->size() : 0, hints);
    ReadCameraMatrix(matrix, model);
    if (coefficients) SetCoefficients(distortion, *coefficients, model);
    CompleteField(distortion, model);
    return model;
}

std::string Matrix(const std::string& name, int rows, int columns,
                   const std::vector<double>& numbers) {
    return name + ": !!opencv-matrix\n   rows: " + std::to_string(rows) +
           "\n   cols: " + std::to_string(columns) + "\n   dt: d\n   data: " + ListText(numbers) +
           "\n";
}

}  // namespace

std::vector<ForeignCamera> ReadOpenCv(YamlMap& root, const ImportHints& hints,
                                      const std::string& name) {
    const CameraModel sized = ReadOpenCvSize(root, hints);
    if (root["M1"].given() && root["M2"].given()) {
        return {{"left", ReadLens(sized, root, root["M1"], root.Required("D1"), hints), {}},
                {"right", ReadLens(sized, root, root["M2"], root.Required("D2"), hints), {}}};
    }
    if (const YamlValue xi = root["xi"]; xi.given())
        xi.Refuse(
            "absent: the omnidirectional model has no counterpart here; calibrate again as "
            "fisheye");
    const YamlValue matrix = FirstOf(
        root, {"camera_matrix", "K", "Camera_Matrix", "cameraMatrix", "cameraMatrix1", "M", "M1"});
    const YamlValue distortion =
        FirstOf(root, {"distortion_coefficients", "D", "Distortion_Coefficients", "dist_coeffs",
                       "distCoeffs", "dist_coeff", "distortion_coeffs", "distCoeffs1", "D1"});
    return {{name, ReadLens(sized, root, matrix, distortion, hints), {}}};
}

std::string OpenCvText(const CameraModel& m) {
    const std::vector<double> coefficients = Coefficients(m);
    const bool fisheye = m.kind == Kind::kKannalaBrandt4;
    return "%YAML:1.0\n---\nimage_width: " + std::to_string(m.width_px) +
           "\nimage_height: " + std::to_string(m.height_px) +
           "\nmodel: " + (fisheye ? "fisheye" : "pinhole") +
           "\nfisheye_model: " + (fisheye ? "1\n" : "0\n") +
           Matrix("camera_matrix", 3, 3, {m.fx_px, 0, m.cx_px, 0, m.fy_px, m.cy_px, 0, 0, 1}) +
           Matrix("distortion_coefficients", static_cast<int>(coefficients.size()), 1,
                  coefficients);
}

}  // namespace hitchview::calib
