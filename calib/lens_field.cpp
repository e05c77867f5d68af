#include "calib/lens_field.hpp"

#include <algorithm>
#include <cmath>

namespace hitchview::calib {
namespace {

using algo::CameraModel;

/// The polynomial may turn back between the last corner seen and the corner of the picture.
double GrowsUpTo(const CameraModel& model) {
    constexpr double kStep = 0.005;
    const double most = model.kind == CameraModel::Kind::kPinholeRadtan ? 1.5 : 3.1;
    CameraModel everywhere = model;
    everywhere.max_theta_rad = 3.14;
    double last = -1;
    double theta = 0;
    for (; theta < most; theta += kStep) {
        const auto at = everywhere.Project({std::sin(theta), 0, std::cos(theta)});
        const double radius = (at->x() - model.cx_px) / model.fx_px;
        if (!(radius > last)) break;
        last = radius;
        if (std::abs(radius) * model.fx_px > std::hypot(model.width_px, model.height_px)) break;
    }
    return std::max(0.05, theta - 2 * kStep);
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
