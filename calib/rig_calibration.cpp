#include "calib/rig_calibration.hpp"

#include <numbers>
#include <string_view>

#include "calib/camera_model_yaml.hpp"
#include "calib/replace_file.hpp"
#include "calib/sha256.hpp"
#include "calib/yaml_map.hpp"

namespace hitchview::calib {
namespace {

using Eigen::Quaterniond;
using Eigen::Vector3d;

constexpr std::size_t kShownIdDigits = 12;

std::string CameraText(const CalibratedCamera& camera) {
    const Quaterniond& q = camera.q_unit_camera;
    const Vector3d& p = camera.position_m;
    const std::string indent = "\n    ";
    return indent + "unit: " + algo::ToString(camera.unit) +  //
           CameraModelText(camera.model, indent) +            //
           indent + "rotation: {quaternion_wxyz: " + ExactText({q.w(), q.x(), q.y(), q.z()}) + "}" +
           indent + "position_m: " + ExactText({p.x(), p.y(), p.z()}) + "\n";
}

/// What the id stands for.
std::string Content(const RigCalibration& calibration) {
    std::string text = "vehicle: " + Quoted(calibration.vehicle) + "\ncameras:\n";
    for (const auto& [name, camera] : calibration.cameras) {
        text += "  " + name + ":" + CameraText(camera);
    }
    return text;
}

}  // namespace

bool IsName(std::string_view name) {
    constexpr std::string_view kAllowed =
        "ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789_";
    return !name.empty() && name.find_first_not_of(kAllowed) == name.npos;
}

std::string_view ToString(Verdict verdict) {
    switch (verdict) {
        case Verdict::kPass:
            return "pass";
        case Verdict::kFail:
            return "fail";
        case Verdict::kUnchecked:
            break;
    }
    return "unchecked";
}

algo::CameraGeometry CalibratedCamera::Geometry() const {
    algo::CameraGeometry geometry{model, Eigen::Isometry3d::Identity()};
    geometry.T_unit_camera.linear() = q_unit_camera.normalized().toRotationMatrix();
    geometry.T_unit_camera.translation() = position_m;
    return geometry;
}

CalibratedCamera CalibratedCamera::From(algo::Unit unit, const algo::CameraGeometry& geometry) {
    return {unit, geometry.model, Quaterniond(geometry.T_unit_camera.linear()),
            geometry.T_unit_camera.translation()};
}

Quaterniond RotationFromRpy(const Vector3d& rpy_deg) {
    const Vector3d rpy_rad = rpy_deg * (std::numbers::pi / 180);
    const Quaterniond q_unit_body = Eigen::AngleAxisd(rpy_rad.z(), Vector3d::UnitZ()) *
                                    Eigen::AngleAxisd(rpy_rad.y(), Vector3d::UnitY()) *
                                    Eigen::AngleAxisd(rpy_rad.x(), Vector3d::UnitX());
    // The camera's x, y, z are the body's -y, -z, x.
    const Quaterniond q_body_camera(0.5, -0.5, 0.5, -0.5);
    return q_unit_body * q_body_camera;
}

std::string RigCalibration::id() const {
    return Sha256(Content(*this)).substr(0, kShownIdDigits);
}

std::string ToYaml(const RigCalibration& calibration) {
    return "schema: 1\nverdict: " + std::string(ToString(calibration.verdict)) +
           "\nwritten_by: " + Quoted(calibration.written_by) + "\nid: \"" + calibration.id() +
           "\"\n" + Content(calibration);
}

std::string SaveCalibration(const RigCalibration& calibration, const std::filesystem::path& file) {
    // What could not be read back must not replace what can.
    return ReplaceFile(file, ToYaml(calibration), [](const std::filesystem::path& fresh) {
        return LoadCalibration(fresh).error;
    });
}

}  // namespace hitchview::calib
