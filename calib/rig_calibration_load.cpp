#include <array>
#include <cmath>
#include <numbers>
#include <string_view>

#include "calib/camera_model_yaml.hpp"
#include "calib/rig_calibration.hpp"
#include "calib/yaml_map.hpp"

namespace hitchview::calib {
namespace {

using Eigen::Quaterniond;
using Eigen::Vector3d;

constexpr std::array kUnitNames{Choice<algo::Unit>{"tractor", algo::Unit::kTractor},
                                Choice<algo::Unit>{"trailer", algo::Unit::kTrailer}};

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
    camera.model = ReadCameraModel(map);
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
    ReadVerdict(root.Required("verdict"), calibration.verdict);
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
