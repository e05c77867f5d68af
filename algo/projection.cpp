#include "algo/projection.hpp"

#include <cmath>
#include <numbers>

namespace hitchview::algo {

using Eigen::Matrix3d;
using Eigen::Vector2d;
using Eigen::Vector3d;

namespace {

constexpr double kTwoPi = 2 * std::numbers::pi;

Matrix3d PlaneAbout(const Vector2d& centre, const Vector2d& shift, double turn) {
    const double c = std::cos(turn);
    const double s = std::sin(turn);
    Matrix3d pose = Matrix3d::Identity();
    pose.topLeftCorner<2, 2>() << c, -s, s, c;
    pose.topRightCorner<2, 1>() = centre + shift - pose.topLeftCorner<2, 2>() * centre;
    return pose;
}

}  // namespace

Projection Projection::Plane(int width_px, int height_px) {
    return {.kind = Kind::kPlane, .width_px = width_px, .height_px = height_px};
}

Projection Projection::Cylinder(int width_px, int height_px, double horizon,
                                double azimuth_centre_rad) {
    return {.kind = Kind::kCylinder,
            .width_px = width_px,
            .height_px = height_px,
            .focal_px = width_px / kTwoPi,
            .horizon_y_px = horizon * height_px - 0.5,
            .azimuth_centre_rad = azimuth_centre_rad};
}

Projection Projection::Scaled(double scale) const {
    Projection scaled = *this;
    scaled.width_px = static_cast<int>(std::lround(width_px * scale));
    scaled.height_px = static_cast<int>(std::lround(height_px * scale));
    scaled.focal_px = IsRing() ? scaled.width_px / kTwoPi : 1;
    scaled.horizon_y_px = (horizon_y_px + 0.5) * scale - 0.5;
    return scaled;
}

Vector3d Projection::Ray(const Vector2d& pixel) const {
    if (kind == Kind::kPlane) return {pixel.x(), pixel.y(), 1};
    const double azimuth = azimuth_centre_rad + (Centre().x() - pixel.x()) / focal_px;
    return {std::cos(azimuth), std::sin(azimuth), (horizon_y_px - pixel.y()) / focal_px};
}

Vector2d Projection::Pixel(const Vector3d& ray) const {
    if (kind == Kind::kPlane) return ray.hnormalized();
    const double azimuth = std::atan2(ray.y(), ray.x()) - azimuth_centre_rad;
    const double across = std::max(1e-9, std::hypot(ray.x(), ray.y()));
    return {WrapColumn(Centre().x() - focal_px * azimuth, width_px),
            horizon_y_px - focal_px * ray.z() / across};
}

PoseOffset ToOffset(const Projection& projection, const Matrix3d& pose) {
    if (projection.IsRing()) {
        const Eigen::AngleAxisd turn(pose);
        const Vector3d rotation = turn.angle() * turn.axis();
        return {Vector3d{-projection.focal_px * rotation.z(), rotation.x(), rotation.y()}};
    }
    const Vector2d centre = projection.Centre();
    const Vector2d shift = (pose * centre.homogeneous()).hnormalized() - centre;
    return {Vector3d{shift.x(), shift.y(),
                     std::atan2(pose(1, 0) - pose(0, 1), pose(0, 0) + pose(1, 1))}};
}

Matrix3d ToPose(const Projection& projection, const PoseOffset& offset) {
    if (projection.IsRing()) {
        const Vector3d rotation{offset.value.y(), offset.value.z(),
                                -offset.value.x() / projection.focal_px};
        const double angle = rotation.norm();
        if (angle < 1e-12) return Matrix3d::Identity();
        return Eigen::AngleAxisd(angle, rotation / angle).toRotationMatrix();
    }
    return PlaneAbout(projection.Centre(), offset.value.head<2>(), offset.value.z());
}

Matrix3d ZoomAbout(const Vector2d& centre, double zoom) {
    Matrix3d m = Matrix3d::Identity();
    m(0, 0) = m(1, 1) = zoom;
    m.topRightCorner<2, 1>() = (1 - zoom) * centre;
    return m;
}

double ScaleOf(const Projection& projection, const Matrix3d& pose) {
    if (projection.IsRing()) return 1;
    return std::sqrt(std::abs(pose.topLeftCorner<2, 2>().determinant())) / std::abs(pose(2, 2));
}

}  // namespace hitchview::algo
