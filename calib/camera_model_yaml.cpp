#include "calib/camera_model_yaml.hpp"

#include <array>
#include <cmath>
#include <initializer_list>
#include <numbers>

namespace hitchview::calib {
namespace {

using algo::CameraModel;

constexpr std::array kModels{
    Choice<CameraModel::Kind>{"kannala_brandt4", CameraModel::Kind::kKannalaBrandt4},
    Choice<CameraModel::Kind>{"pinhole_radtan", CameraModel::Kind::kPinholeRadtan}};

std::string Distortion(const CameraModel& m) {
    const auto& d = m.distortion;
    return m.kind == CameraModel::Kind::kPinholeRadtan ? ExactText({d[0], d[1], d[2], d[3], d[4]})
                                                       : ExactText({d[0], d[1], d[2], d[3]});
}

constexpr std::array kVerdicts{Choice<Verdict>{"pass", Verdict::kPass},
                               Choice<Verdict>{"fail", Verdict::kFail},
                               Choice<Verdict>{"unchecked", Verdict::kUnchecked}};

constexpr double kMaxTheta[] = {1.57, 3.14};  // rad; just below pi/2 and pi

std::size_t CoefficientCount(CameraModel::Kind kind) {
    return kind == CameraModel::Kind::kPinholeRadtan ? 5 : 4;
}

/// The distortion polynomial has an inverse only while it grows.
bool GrowsUpToMaxTheta(const CameraModel& model) {
    constexpr int kSteps = 200;
    for (int side = 0; side < 8; ++side) {
        const double azimuth = side * std::numbers::pi / 4;
        double last = 0;
        for (int i = 1; i <= kSteps; ++i) {
            const double theta = model.max_theta_rad * i / (kSteps + 1);
            const auto pixel =
                model.Project({std::sin(theta) * std::cos(azimuth),
                               std::sin(theta) * std::sin(azimuth), std::cos(theta)});
            if (!pixel) return false;
            const double radius = std::hypot((pixel->x() - model.cx_px) / model.fx_px,
                                             (pixel->y() - model.cy_px) / model.fy_px);
            if (!(radius > last)) return false;
            last = radius;
        }
    }
    return true;
}

void ReadDistortion(const YamlValue& value, CameraModel& model) {
    const std::size_t count = CoefficientCount(model.kind);
    const auto items = value.List({count, count});
    for (std::size_t i = 0; i < items.size(); ++i) {
        items[i].Read(Range<double>{-100, 100}, model.distortion[i]);
    }
}

void ReadPair(const YamlValue& value, const Range<double>& range, double& first, double& second) {
    std::array<double, 2> pair{first, second};
    value.Read(range, pair);
    first = pair[0];
    second = pair[1];
}

}  // namespace

CameraModel ReadCameraModel(YamlMap& map) {
    CameraModel model;
    map.Required("model").Read(kModels, model.kind);
    std::array<int, 2> size_px{};
    map.Required("size_px").Read(Range<int>{64, 8192}, size_px);
    model.width_px = size_px[0];
    model.height_px = size_px[1];
    ReadPair(map.Required("focal_px"), {10, 20000}, model.fx_px, model.fy_px);
    ReadPair(map.Required("centre_px"), {0, 8192}, model.cx_px, model.cy_px);
    ReadDistortion(map.Required("distortion"), model);
    const double max_theta = kMaxTheta[model.kind == CameraModel::Kind::kPinholeRadtan ? 0 : 1];
    const YamlValue theta = map.Required("max_theta_rad");
    theta.Read(Range<double>{0.05, max_theta}, model.max_theta_rad);
    if (model.fx_px > 0 && model.fy_px > 0 && !GrowsUpToMaxTheta(model)) {
        theta.Refuse("smaller: the distortion stops growing before this angle");
    }
    return model;
}

void ReadVerdict(const YamlValue& value, Verdict& verdict) {
    value.Read(kVerdicts, verdict);
}

std::string CameraModelText(const CameraModel& m, const std::string& line_start) {
    return line_start + "model: " + std::string(algo::ToString(m.kind)) +                     //
           line_start + "size_px: " + ExactText({double(m.width_px), double(m.height_px)}) +  //
           line_start + "focal_px: " + ExactText({m.fx_px, m.fy_px}) +                        //
           line_start + "centre_px: " + ExactText({m.cx_px, m.cy_px}) +                       //
           line_start + "distortion: " + Distortion(m) +                                      //
           line_start + "max_theta_rad: " + ExactText(m.max_theta_rad);
}

}  // namespace hitchview::calib
