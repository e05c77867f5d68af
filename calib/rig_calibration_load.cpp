#include <array>
#include <cmath>
#include <numbers>
#include <string_view>

#include "calib/rig_calibration.hpp"
#include "calib/yaml_map.hpp"

namespace hitchview::calib {
namespace {

using algo::CameraModel;
using Eigen::Quaterniond;
using Eigen::Vector3d;

constexpr std::array kVerdicts{Choice<Verdict>{"pass", Verdict::kPass},
                               Choice<Verdict>{"fail", Verdict::kFail},
                               Choice<Verdict>{"unchecked", Verdict::kUnchecked}};
constexpr std::array kUnitNames{Choice<algo::Unit>{"tractor", algo::Unit::kTractor},
                                Choice<algo::Unit>{"trailer", algo::Unit::kTrailer}};
constexpr std::array kModels{
    Choice<CameraModel::Kind>{"kannala_brandt4", CameraModel::Kind::kKannalaBrandt4},
    Choice<CameraModel::Kind>{"pinhole_radtan", CameraModel::Kind::kPinholeRadtan}};

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

CameraModel ReadModel(YamlMap& map) {
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

Quaterniond ReadRotation(const YamlValue& value) {
    YamlMap map = value.Map();
    const YamlValue quaternion = map["quaternion_wxyz"];
    const YamlValue rpy = map["rpy_deg"];
    map.Finish();
    Quaterniond q = Quaterniond::Identity();
    if (quaternion.given() == rpy.given()) {
        value.Refuse("a map with either quaternion_wxyz or rpy_deg");
    } else if (rpy.given()) {
        std::array<double, 3> angles_deg{};
        rpy.Read(Range<double>{-360, 360}, angles_deg);
        q = RotationFromRpy(Vector3d(angles_deg.data()));
    } else {
        std::array<double, 4> wxyz{1, 0, 0, 0};
        quaternion.Read(Range<double>{-1.000001, 1.000001}, wxyz);
        q = {wxyz[0], wxyz[1], wxyz[2], wxyz[3]};
        if (std::abs(q.norm() - 1) > 1e-6) quaternion.Refuse("of length 1 within 1e-6");
    }
    return q;
}

CalibratedCamera ReadCamera(const YamlValue& value) {
    CalibratedCamera camera;
    YamlMap map = value.Map();
    map.Required("unit").Read(kUnitNames, camera.unit);
    camera.model = ReadModel(map);
    camera.q_unit_camera = ReadRotation(map.Required("rotation"));
    std::array<double, 3> position_m{};
    map.Required("position_m").Read(Range<double>{-50, 50}, position_m);
    camera.position_m = Vector3d(position_m.data());
    map.Finish();
    return camera;
}

RigCalibration ReadCalibration(YamlMap& root) {
    RigCalibration calibration;
    int schema = 1;
    root.Required("schema").Read(Range<int>{1, 1}, schema);
    root.Required("vehicle").Read(calibration.vehicle);
    root.Required("verdict").Read(kVerdicts, calibration.verdict);
    root.Required("written_by").Read(calibration.written_by);
    YamlMap cameras = root.Required("cameras").Map();
    for (const std::string& name : cameras.keys()) {
        const YamlValue camera = cameras.Required(name);
        if (!IsName(name)) camera.Refuse("named with letters, digits and _ only");
        calibration.cameras.emplace(name, ReadCamera(camera));
    }
    return calibration;
}

void CheckId(const YamlValue& value, const std::string& id) {
    std::string given = id;
    value.Read(given);
    if (given != id) value.Refuse(id + " for this content; without the key nothing is compared");
}

LoadedCalibration ReadWhole(YamlMap root, const YamlComplaints& complaints) {
    RigCalibration calibration = ReadCalibration(root);
    const YamlValue cameras = root["cameras"];
    const YamlValue id = root["id"];
    if (complaints.empty() && calibration.cameras.empty())
        cameras.Refuse("a map of cameras by name");
    if (complaints.empty()) CheckId(id, calibration.id());
    root.Finish();
    if (!complaints.empty()) return {std::nullopt, complaints.Text()};
    return {std::move(calibration), ""};
}

}  // namespace

LoadedCalibration LoadCalibration(const std::filesystem::path& file) {
    YamlComplaints complaints(file.string());
    return ReadWhole(LoadYaml(file, complaints), complaints);
}

LoadedCalibration ParseCalibration(const std::string& text, const std::string& name) {
    YamlComplaints complaints(name);
    return ReadWhole(ParseYaml(text, complaints), complaints);
}

}  // namespace hitchview::calib
