#include "calib/panorama_holes.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>

namespace hitchview::calib {
namespace {

using algo::UnitGeometry;

constexpr double kHorizonBand_rad = 5 * std::numbers::pi / 180;

struct Axis {
    std::string camera;
    double azimuth_rad = 0;
};

std::vector<Axis> AxesByAzimuth(const RigCalibration& calibration) {
    std::vector<Axis> axes;
    for (const auto& [name, camera] : calibration.cameras) {
        const Eigen::Vector3d axis = camera.q_unit_camera * Eigen::Vector3d::UnitZ();
        axes.push_back({name, std::atan2(axis.y(), axis.x())});
    }
    std::ranges::sort(axes, {}, &Axis::azimuth_rad);
    return axes;
}

std::vector<UnitGeometry> Units(const RigCalibration& calibration, const algo::Projection& canvas,
                                const algo::AlignmentSurface& surface) {
    std::vector<UnitGeometry> units;
    for (const algo::Unit unit : algo::kUnits) {
        std::vector<algo::CameraGeometry> cameras;
        for (const auto& [name, camera] : calibration.cameras)
            if (camera.unit == unit) cameras.push_back(camera.Geometry());
        if (!cameras.empty()) units.push_back(UnitGeometry::Ring(canvas, cameras, surface));
    }
    return units;
}

bool IsCovered(const std::vector<UnitGeometry>& units, const Eigen::Vector3d& ray) {
    return std::ranges::any_of(units, [&](const UnitGeometry& unit) {
        UnitGeometry::Sights sights;
        unit.See(ray, sights);
        return std::any_of(sights.begin(), sights.end(),
                           [](const algo::CameraSight& sight) { return sight.weight > 0; });
    });
}

/// Index of the last axis that is not to the left of `azimuth_rad`; the last of all before the
/// first.
std::size_t SeamAt(const std::vector<Axis>& axes, double azimuth_rad) {
    const auto next = std::ranges::upper_bound(axes, azimuth_rad, {}, &Axis::azimuth_rad);
    return next == axes.begin() ? axes.size() - 1
                                : static_cast<std::size_t>(next - axes.begin()) - 1;
}

void CountColumn(const std::vector<UnitGeometry>& units, const algo::Projection& canvas, int x,
                 SeamHole& hole) {
    bool at_horizon = false;
    for (int y = 0; y < canvas.height_px; ++y) {
        const Eigen::Vector3d ray = canvas.Ray({x, y});
        if (IsCovered(units, ray)) continue;
        ++hole.uncovered_px;
        at_horizon = at_horizon || std::abs(std::atan(ray.z())) < kHorizonBand_rad;
    }
    if (at_horizon) ++hole.gap_at_horizon_px;
}

}  // namespace

std::vector<SeamHole> FindHoles(const RigCalibration& calibration, const algo::Projection& canvas,
                                const algo::AlignmentSurface& surface) {
    const std::vector<Axis> axes = AxesByAzimuth(calibration);
    const std::vector<UnitGeometry> units = Units(calibration, canvas, surface);
    std::vector<SeamHole> holes;
    for (std::size_t i = 0; i < axes.size(); ++i)
        holes.push_back({.right = axes[i].camera, .left = axes[(i + 1) % axes.size()].camera});
    for (int x = 0; x < canvas.width_px; ++x) {
        const Eigen::Vector3d ray = canvas.Ray({x, 0});
        CountColumn(units, canvas, x, holes[SeamAt(axes, std::atan2(ray.y(), ray.x()))]);
    }
    return holes;
}

}  // namespace hitchview::calib
