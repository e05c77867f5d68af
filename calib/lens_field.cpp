#include "calib/lens_field.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>

namespace hitchview::calib {
namespace {

using algo::CameraModel;

/// Where the picture of a ray stands, in focal lengths from the centre.
double Radius(const CameraModel& lens, double theta, double azimuth) {
    const auto at = lens.Project({std::sin(theta) * std::cos(azimuth),
                                  std::sin(theta) * std::sin(azimuth), std::cos(theta)});
    return std::hypot((at->x() - lens.cx_px) / lens.fx_px, (at->y() - lens.cy_px) / lens.fy_px);
}

/// The polynomial may turn back between the last corner seen and the corner of the picture.
double GrowsUpTo(const CameraModel& lens, double azimuth) {
    constexpr double kStep = 0.002;
    const double most = lens.kind == CameraModel::Kind::kPinholeRadtan ? 1.5 : 3.1;
    const double picture =
        std::hypot(lens.width_px, lens.height_px) / std::min(lens.fx_px, lens.fy_px);
    CameraModel everywhere = lens;
    everywhere.max_theta_rad = 3.14;
    double last = 0;
    for (double theta = kStep; theta < most; theta += kStep) {
        const double radius = Radius(everywhere, theta, azimuth);
        if (!(radius > last)) return std::max(0.0, theta - 2 * kStep);
        if (radius > picture) return theta;
        last = radius;
    }
    return most;
}

double GrowsUpTo(const CameraModel& lens) {
    constexpr int kSides = 16;
    double theta = std::numbers::pi;
    for (int side = 0; side < kSides; ++side)
        theta = std::min(theta, GrowsUpTo(lens, side * 2 * std::numbers::pi / kSides));
    return theta;
}

}  // namespace

double FieldOf(const CameraModel& lens) {
    CameraModel model = lens;
    model.max_theta_rad = GrowsUpTo(model);
    double farthest = 0;
    for (const double x : {0.0, model.width_px - 1.0}) {
        for (const double y : {0.0, model.height_px - 1.0}) {
            const auto direction = model.Unproject({x, y});
            if (!direction) return model.max_theta_rad;
            farthest = std::max(farthest, std::acos(std::clamp(direction->z(), -1.0, 1.0)));
        }
    }
    return std::min(model.max_theta_rad, farthest + 0.01);
}

}  // namespace hitchview::calib
