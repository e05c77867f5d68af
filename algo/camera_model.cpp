#include "algo/camera_model.hpp"

#include <cmath>

#include "algo/camera_projection.hpp"

namespace hitchview::algo {
namespace {

using Eigen::Vector2d;
using Eigen::Vector3d;

constexpr int kMaxNewtonSteps = 30;

double FisheyeRadius(const CameraModel& m, double theta) {
    return algo::FisheyeRadius(m.distortion.data(), theta);
}

double FisheyeRadiusDerivative(const CameraModel& m, double theta) {
    const auto& k = m.distortion;
    const double t2 = theta * theta;
    return 1 + t2 * (3 * k[0] + t2 * (5 * k[1] + t2 * (7 * k[2] + t2 * 9 * k[3])));
}

Vector2d Radtan(const CameraModel& m, const Vector2d& n) {
    return algo::RadtanPoint(m.distortion.data(), n.x(), n.y());
}

Eigen::Matrix2d RadtanJacobian(const CameraModel& m, const Vector2d& n) {
    const auto& [k1, k2, p1, p2, k3] = m.distortion;
    const double a = n.x();
    const double b = n.y();
    const double r2 = a * a + b * b;
    const double d = 1 + r2 * (k1 + r2 * (k2 + r2 * k3));
    const double e = 2 * (k1 + r2 * (2 * k2 + r2 * 3 * k3));  // d(d)/d(a) = e a
    Eigen::Matrix2d j;
    j << d + e * a * a + 2 * p1 * b + 6 * p2 * a, e * a * b + 2 * p1 * a + 2 * p2 * b,
        e * a * b + 2 * p1 * a + 2 * p2 * b, d + e * b * b + 6 * p1 * b + 2 * p2 * a;
    return j;
}

Vector2d ToPixel(const CameraModel& m, const Vector2d& distorted) {
    return {m.fx_px * distorted.x() + m.cx_px, m.fy_px * distorted.y() + m.cy_px};
}

std::optional<Vector3d> UnprojectFisheye(const CameraModel& m, const Vector2d& distorted) {
    const double radius = distorted.norm();
    if (radius < 1e-12) return Vector3d::UnitZ();
    double theta = std::min(radius, m.max_theta_rad);
    for (int i = 0; i < kMaxNewtonSteps; ++i) {
        const double slope = FisheyeRadiusDerivative(m, theta);
        if (slope <= 1e-6) return std::nullopt;
        const double step = (FisheyeRadius(m, theta) - radius) / slope;
        theta -= step;
        if (std::abs(step) < 1e-12) break;
    }
    if (!(theta >= 0 && theta <= m.max_theta_rad) ||
        std::abs(FisheyeRadius(m, theta) - radius) > 1e-9) {
        return std::nullopt;
    }
    const Vector2d side = distorted / radius * std::sin(theta);
    return Vector3d{side.x(), side.y(), std::cos(theta)};
}

std::optional<Vector3d> UnprojectRadtan(const CameraModel& m, const Vector2d& distorted) {
    Vector2d n = distorted;
    for (int i = 0; i < kMaxNewtonSteps; ++i) {
        const Vector2d step = RadtanJacobian(m, n).inverse() * (Radtan(m, n) - distorted);
        if (!step.allFinite()) return std::nullopt;
        n -= step;
        if (step.squaredNorm() < 1e-24) break;
    }
    if ((Radtan(m, n) - distorted).norm() > 1e-9 || std::atan(n.norm()) > m.max_theta_rad) {
        return std::nullopt;
    }
    return Vector3d{n.x(), n.y(), 1}.normalized();
}

}  // namespace

std::optional<Vector2d> CameraModel::Project(const Vector3d& p_camera) const {
    const Vector2d side = p_camera.head<2>();
    const double across = side.norm();
    const double theta = std::atan2(across, p_camera.z());
    if (theta > max_theta_rad) return std::nullopt;
    if (kind == Kind::kPinholeRadtan) {
        return ToPixel(*this, Radtan(*this, side / p_camera.z()));
    }
    if (across < 1e-12) return Vector2d{cx_px, cy_px};
    return ToPixel(*this, side * (FisheyeRadius(*this, theta) / across));
}

std::optional<Vector3d> CameraModel::Unproject(const Vector2d& pixel) const {
    const Vector2d distorted{(pixel.x() - cx_px) / fx_px, (pixel.y() - cy_px) / fy_px};
    return kind == Kind::kPinholeRadtan ? UnprojectRadtan(*this, distorted)
                                        : UnprojectFisheye(*this, distorted);
}

std::string_view ToString(CameraModel::Kind kind) {
    return kind == CameraModel::Kind::kPinholeRadtan ? "pinhole_radtan" : "kannala_brandt4";
}

}  // namespace hitchview::algo
