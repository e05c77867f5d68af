#include "calib/format_pose.hpp"

#include <Eigen/LU>
#include <cmath>

#include "calib/format_lens.hpp"

namespace hitchview::calib {
namespace {

using Eigen::Isometry3d;
using Eigen::Matrix3d;
using Eigen::Matrix4d;
using Eigen::Vector3d;

constexpr double kFarthest_m = 1e4;

bool IsRigid(const Matrix4d& T) {
    constexpr double kTolerance = 1e-5;
    const Matrix3d R = T.topLeftCorner<3, 3>();
    return (R * R.transpose() - Matrix3d::Identity()).cwiseAbs().maxCoeff() < kTolerance &&
           R.determinant() > 0 && T.topRightCorner<3, 1>().cwiseAbs().maxCoeff() < kFarthest_m &&
           T.row(3) == Eigen::RowVector4d(0, 0, 0, 1);
}

}  // namespace

std::optional<Isometry3d> ReadMatrixPose(const YamlValue& value) {
    const auto n = ReadNumbers(value, {16, 16});
    if (!n) return std::nullopt;
    const Matrix4d T = Eigen::Map<const Eigen::Matrix<double, 4, 4, Eigen::RowMajor>>(n->data());
    if (!IsRigid(T)) {
        value.Refuse("a rotation and a translation in metres, with 0 0 0 1 below");
        return std::nullopt;
    }
    Isometry3d pose = Isometry3d::Identity();
    pose.linear() =
        Eigen::Quaterniond(Matrix3d(T.topLeftCorner<3, 3>())).normalized().toRotationMatrix();
    pose.translation() = T.topRightCorner<3, 1>();
    return pose;
}

std::optional<Isometry3d> ReadRtPose(const YamlValue& value) {
    const auto n = ReadNumbers(value, {6, 6});
    if (!n) return std::nullopt;
    const Vector3d r = Eigen::Map<const Vector3d>(n->data());
    const Vector3d t = Eigen::Map<const Vector3d>(n->data() + 3);
    if (r.norm() > kFarthest_m || t.norm() > kFarthest_m) {
        value.Refuse("a rotation in radians and a translation in metres");
        return std::nullopt;
    }
    Isometry3d pose = Isometry3d::Identity();
    if (r.norm() > 0) pose.linear() = Eigen::AngleAxisd(r.norm(), r.normalized()).matrix();
    pose.translation() = t;
    return pose;
}

std::string MatrixPoseText(const Isometry3d& pose, const std::string& line_start) {
    std::string text;
    const Matrix4d T = pose.matrix();
    for (int row = 0; row < 4; ++row)
        text += line_start + ListText({T(row, 0), T(row, 1), T(row, 2), T(row, 3)});
    return text;
}

std::string RtPoseText(const Isometry3d& pose) {
    const Eigen::AngleAxisd turn(pose.linear());
    const Vector3d r = turn.angle() * turn.axis();
    const Vector3d t = pose.translation();
    return ListText({r.x(), r.y(), r.z(), t.x(), t.y(), t.z()});
}

}  // namespace hitchview::calib
