#include "calib/format_kalibr.hpp"

#include <array>

#include "calib/format_pose.hpp"

namespace hitchview::calib {
namespace {

using algo::CameraModel;
using Eigen::Isometry3d;
using Kind = CameraModel::Kind;

enum class Distortion { kNone, kRadtan, kEquidistant };

constexpr std::array kProjections{Choice<int>{"pinhole", 0}};
constexpr std::array kDistortions{Choice<Distortion>{"radtan", Distortion::kRadtan},
                                  Choice<Distortion>{"equidistant", Distortion::kEquidistant},
                                  Choice<Distortion>{"equi", Distortion::kEquidistant},
                                  Choice<Distortion>{"none", Distortion::kNone}};
constexpr std::size_t kMostCameras = 64;

/// One entry of the chain, before its place in the whole is known.
struct Link {
    ForeignCamera camera{};
    std::optional<Isometry3d> T_camera_last{};  ///< last: the camera before it
    std::optional<Isometry3d> T_camera_imu{};
};

CameraModel ReadLens(YamlMap& map, const ImportHints& hints) {
    CameraModel model;
    int projection = 0;
    Distortion distortion = Distortion::kEquidistant;
    map.Required("camera_model").Read(kProjections, projection);
    const YamlValue kind = map.Required("distortion_model");
    kind.Read(kDistortions, distortion);
    model.kind =
        distortion == Distortion::kEquidistant ? Kind::kKannalaBrandt4 : Kind::kPinholeRadtan;
    if (hints.kind && model.kind != *hints.kind)
        kind.Refuse("as --model says, " + std::string(ToString(*hints.kind)));
    const YamlValue size = map.Required("resolution");
    ReadSize(size, model);
    CheckSize(size, hints, model);
    ReadFourIntrinsics(map.Required("intrinsics"), model);
    const YamlValue coefficients = map.Required("distortion_coeffs");
    const auto read = distortion == Distortion::kNone ? std::vector<double>(4)
                                                      : ReadNumbers(coefficients, {4, 4});
    if (read) SetCoefficients(coefficients, *read, model);
    CompleteField(coefficients, model);
    return model;
}

/// `/tractor_front/image_raw` names tractor_front.
std::string NameOf(YamlMap& map, const std::string& key) {
    std::string topic;
    if (const YamlValue value = map["rostopic"]; value.given()) value.Read(topic);
    if (!topic.starts_with('/')) return key;
    const std::size_t end = topic.find('/', 1);
    return AsName(std::string_view(topic).substr(1, end == topic.npos ? end : end - 1), key);
}

/// `chained`: its place is known by the camera before it.
Link ReadLink(const std::string& key, YamlMap map, const ImportHints& hints, bool chained) {
    Link link{.camera = {.name = NameOf(map, key), .model = ReadLens(map, hints)}};
    if (const YamlValue imu = map["T_cam_imu"]; imu.given()) {
        link.T_camera_imu = ReadMatrixPose(imu);
    }
    if (chained) link.T_camera_last = ReadMatrixPose(map.Required("T_cn_cnm1"));
    return link;
}

bool HasPlace(const YamlValue& camera) {
    return camera.is_map() && camera.Map()["T_cam_imu"].given();
}

/// Places in the unit where each camera has its own, otherwise in the first camera's frame.
ForeignCameras Chained(std::vector<Link> links) {
    ForeignCameras chain;
    Isometry3d T_camera_first = Isometry3d::Identity();
    const bool in_unit = links.front().T_camera_imu.has_value();
    chain.from_first_camera = !in_unit;
    for (Link& link : links) {
        if (in_unit && link.T_camera_imu) {
            T_camera_first = *link.T_camera_imu;
        } else if (link.T_camera_last) {
            T_camera_first = *link.T_camera_last * T_camera_first;
        }
        link.camera.T_reference_camera = T_camera_first.inverse();
        chain.cameras.push_back(std::move(link.camera));
    }
    return chain;
}

std::string LinkText(const std::string& key, const ForeignCamera& camera,
                     const std::optional<Isometry3d>& T_camera_last) {
    const CameraModel& m = camera.model;
    const bool pinhole = m.kind == Kind::kPinholeRadtan;
    const std::string row = "\n  - ";
    std::string text = key + ":";
    if (T_camera_last) text += "\n  T_cn_cnm1:" + MatrixPoseText(*T_camera_last, row);
    if (camera.T_reference_camera)
        text += "\n  T_cam_imu:" + MatrixPoseText(camera.T_reference_camera->inverse(), row);
    const auto& d = m.distortion;
    return text + "\n  cam_overlaps: []\n  camera_model: pinhole\n  distortion_coeffs: " +
           ExactText({d[0], d[1], d[2], d[3]}) +
           "\n  distortion_model: " + (pinhole ? "radtan" : "equidistant") +
           "\n  intrinsics: " + ExactText({m.fx_px, m.fy_px, m.cx_px, m.cy_px}) +
           "\n  resolution: " + ExactText({double(m.width_px), double(m.height_px)}) +
           "\n  rostopic: /" + camera.name + "/image_raw\n";
}

}  // namespace

ForeignCameras ReadKalibr(YamlMap& root, const ImportHints& hints) {
    std::vector<Link> links;
    for (std::size_t i = 0; i < kMostCameras; ++i) {
        const std::string key = "cam" + std::to_string(i);
        const YamlValue camera = root[key];
        if (i > 0 && !camera.given()) break;
        const bool chained = i > 0 && !(links[0].T_camera_imu && HasPlace(camera));
        links.push_back(ReadLink(key, root.Required(key).Map(), hints, chained));
    }
    return Chained(std::move(links));
}

CamchainText KalibrText(const std::vector<ForeignCamera>& cameras) {
    CamchainText chain;
    std::optional<Isometry3d> T_reference_last;
    for (std::size_t i = 0; i < cameras.size(); ++i) {
        const ForeignCamera& camera = cameras[i];
        if (camera.model.kind == Kind::kPinholeRadtan && camera.model.distortion[4] != 0)
            return {"", camera.name + " has k3 " + ExactText(camera.model.distortion[4]) +
                            ", kalibr's pinhole-radtan has none: export to opencv, ros or mrcal, "
                            "or calibrate as fisheye"};
        std::optional<Isometry3d> T_camera_last;
        if (T_reference_last && camera.T_reference_camera)
            T_camera_last = camera.T_reference_camera->inverse() * *T_reference_last;
        chain.text += LinkText("cam" + std::to_string(i), camera, T_camera_last);
        T_reference_last = camera.T_reference_camera;
    }
    return chain;
}

}  // namespace hitchview::calib
