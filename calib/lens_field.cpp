#include "calib/lens_field.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>

namespace hitchview::calib {
namespace {

using algo::CameraModel;

constexpr double kStep_rad = 0.002;

/// Where the picture of a ray stands, in focal lengths from the centre.
double Radius(const CameraModel& model, double theta, double azimuth) {
    const auto at = model.Project({std::sin(theta) * std::cos(azimuth),
                                   std::sin(theta) * std::sin(azimuth), std::cos(theta)});
    return std::hypot((at->x() - model.cx_px) / model.fx_px, (at->y() - model.cy_px) / model.fy_px);
}

/// `model` has its widest field.
double GrowsUpTo(const CameraModel& model, double azimuth) {
    const double most = model.max_theta_rad - kStep_rad;
    double last = 0;
    double theta = kStep_rad;
    for (; theta < most; theta += kStep_rad) {
        const double radius = Radius(model, theta, azimuth);
        if (!(radius > last)) return std::max(0.0, theta - 2 * kStep_rad);
        last = radius;
    }
    return most;
}

double FarthestCorner(const CameraModel& model) {
    constexpr double kMargin_rad = 0.01;
    double farthest = 0;
    for (const double x : {0.0, model.width_px - 1.0}) {
        for (const double y : {0.0, model.height_px - 1.0}) {
            const auto direction = model.Unproject({x, y});
            if (!direction) return model.max_theta_rad;
            farthest = std::max(farthest, std::acos(std::clamp(direction->z(), -1.0, 1.0)));
        }
    }
    return std::min(model.max_theta_rad, farthest + kMargin_rad);
}

}  // namespace

double WidestField(const CameraModel& model) {
    constexpr int kSides = 16;
    CameraModel widest = model;
    widest.max_theta_rad = model.kind == CameraModel::Kind::kPinholeRadtan ? 1.57 : 3.14;
    double field = widest.max_theta_rad;
    for (int side = 0; side < kSides; ++side) {
        const double azimuth = side * 2 * std::numbers::pi / kSides;
        field = std::min(field, GrowsUpTo(widest, azimuth));
    }
    widest.max_theta_rad = field;
    return FarthestCorner(widest);
}

}  // namespace hitchview::calib
