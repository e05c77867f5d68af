#include "calib/format_mrcal.hpp"

#include <array>

#include "calib/format_pose.hpp"

namespace hitchview::calib {
namespace {

using algo::CameraModel;
using Kind = CameraModel::Kind;

// Each name with its number of coefficients.
constexpr std::array kModels{
    Choice<int>{"LENSMODEL_PINHOLE", 0}, Choice<int>{"LENSMODEL_OPENCV4", 4},
    Choice<int>{"LENSMODEL_OPENCV5", 5}, Choice<int>{"LENSMODEL_OPENCV8", 8},
    Choice<int>{"LENSMODEL_OPENCV12", 12}};

constexpr std::size_t kIntrinsics = 4;

/// Focal lengths, centre and coefficients, one list.
void ReadIntrinsics(const YamlValue& value, std::size_t coefficients, CameraModel& model) {
    const std::size_t count = kIntrinsics + coefficients;
    const auto read = ReadNumbers(value, {count, count});
    if (!read) return;
    const std::vector<double>& n = *read;
    SetIntrinsics(value, {n[0], n[1], n[2], n[3]}, model);
    SetCoefficients(value, {n.begin() + kIntrinsics, n.end()}, model);
}

std::string CommaList(const std::vector<double>& numbers) {
    std::string text = "[";
    for (const double number : numbers) text.append(" ").append(ExactText(number)).append(",");
    return text.append("]");
}

}  // namespace

std::vector<ForeignCamera> ReadMrcal(YamlMap& root, const ImportHints& hints,
                                     const std::string& name) {
    ForeignCamera camera{.name = name};
    camera.model.kind = Kind::kPinholeRadtan;
    int coefficients = -1;
    const YamlValue lens = FirstOf(root, {"lensmodel", "distortion_model"});
    lens.Read(kModels, coefficients);
    if (hints.kind && *hints.kind != Kind::kPinholeRadtan)
        lens.Refuse("as --model says, " + std::string(ToString(*hints.kind)));
    const YamlValue size = FirstOf(root, {"imagersize", "dimensions"});
    ReadSize(size, camera.model);
    CheckSize(size, hints, camera.model);
    const YamlValue intrinsics = root.Required("intrinsics");
    if (coefficients >= 0)
        ReadIntrinsics(intrinsics, static_cast<std::size_t>(coefficients), camera.model);
    CompleteField(intrinsics, camera.model);
    const YamlValue extrinsics = FirstOf(root, {"rt_cam_ref", "extrinsics"});
    if (const auto T_camera_reference = ReadRtPose(extrinsics))
        camera.T_reference_camera = T_camera_reference->inverse();
    return {camera};
}

std::string MrcalRefusal(const ForeignCamera& camera) {
    if (camera.model.kind == Kind::kPinholeRadtan) return "";
    return camera.name +
           " is kannala_brandt4, and none of mrcal's models is this fisheye's: export to opencv, "
           "ros or kalibr, or give the pictures to mrcal-calibrate-cameras with "
           "LENSMODEL_SPLINED_STEREOGRAPHIC";
}

std::string MrcalText(const ForeignCamera& camera) {
    const CameraModel& m = camera.model;
    std::vector<double> intrinsics{m.fx_px, m.fy_px, m.cx_px, m.cy_px};
    intrinsics.insert(intrinsics.end(), m.distortion.begin(), m.distortion.end());
    const Eigen::Isometry3d T_camera_reference =
        camera.T_reference_camera.value_or(Eigen::Isometry3d::Identity()).inverse();
    return "{\n    'lensmodel':  'LENSMODEL_OPENCV5',\n\n"
           "    # fx, fy, cx, cy, k1, k2, p1, p2, k3\n    'intrinsics': " +
           CommaList(intrinsics) +
           ",\n\n    # rt_fromref: takes points of the frame of reference to the camera's\n"
           "    'extrinsics': " +
           RtPoseText(T_camera_reference) +
           ",\n\n    'imagersize': " + CommaList({double(m.width_px), double(m.height_px)}) +
           ",\n}\n";
}

}  // namespace hitchview::calib
