#include "app/calib_report_plan.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>

#include "app/calib_report_json.hpp"
#include "app/calib_report_svg.hpp"

namespace hitchview::app {
namespace {

using nlohmann::json;

constexpr double kWidth = 960;
constexpr double kLargestHeight = 480;
constexpr double kMargin_m = 1;

struct Placed {
    std::string name;
    double x_m;
    double y_m;
    double yaw_rad;
};

std::vector<Placed> PlacedCameras(const json& cameras) {
    constexpr double kFarthest_m = 1e3;
    std::vector<Placed> placed;
    for (const auto& [name, camera] : NamedParts(cameras)) {
        const std::vector<double> at_m = NumbersOf(Part(*camera, "position_m"));
        const std::vector<double> rpy_deg = NumbersOf(Part(*camera, "rpy_deg"));
        if (at_m.size() != 3 || rpy_deg.size() != 3) continue;
        if (std::abs(at_m[0]) > kFarthest_m || std::abs(at_m[1]) > kFarthest_m) continue;
        placed.push_back({name, at_m[0], at_m[1], rpy_deg[2] * std::numbers::pi / 180});
    }
    return placed;
}

/// From metres, forward to the right and left up, to the drawing.
struct Ground {
    double left_m = 0, right_m = 0, low_m = 0, high_m = 0;

    [[nodiscard]] double scale() const { return kWidth / (right_m - left_m); }
    [[nodiscard]] double X(double x_m) const { return (x_m - left_m) * scale(); }
    [[nodiscard]] double Y(double y_m) const { return (high_m - y_m) * scale(); }
};

Ground Around(const std::vector<Placed>& cameras) {
    Ground ground;  // has the hitch point in it
    for (const Placed& camera : cameras) {
        ground.left_m = std::min(ground.left_m, camera.x_m);
        ground.right_m = std::max(ground.right_m, camera.x_m);
        ground.low_m = std::min(ground.low_m, camera.y_m);
        ground.high_m = std::max(ground.high_m, camera.y_m);
    }
    ground = {ground.left_m - kMargin_m, ground.right_m + kMargin_m, ground.low_m - kMargin_m,
              ground.high_m + kMargin_m};
    // As wide as the page, so that letters are as large as elsewhere.
    const double width_m = (ground.high_m - ground.low_m) * kWidth / kLargestHeight;
    const double more_m = std::max(0.0, width_m - (ground.right_m - ground.left_m));
    ground.left_m -= more_m / 2;
    ground.right_m += more_m / 2;
    return ground;
}

std::string CameraSign(const Placed& camera, const Ground& ground) {
    constexpr double kReach = 46;
    constexpr double kHalfField = 0.5;  // rad; of the sign, not of the lens
    const double x = ground.X(camera.x_m);
    const double y = ground.Y(camera.y_m);
    const auto ray = [&](double yaw) {
        return SvgLine(x, y, x + kReach * std::cos(yaw), y - kReach * std::sin(yaw), "look");
    };
    // The name stands behind the camera, where nothing else is drawn.
    const bool forward = std::cos(camera.yaw_rad) > 0;
    return ray(camera.yaw_rad - kHalfField) + ray(camera.yaw_rad + kHalfField) +
           SvgDot(x, y, 5, "node") +
           SvgText(x + (forward ? -9 : 9), y + 4 + 14 * std::sin(camera.yaw_rad),
                   forward ? "end" : "start", camera.name);
}

}  // namespace

std::string PlanView(const json& cameras) {
    const std::vector<Placed> placed = PlacedCameras(cameras);
    if (placed.empty()) return kNotInFile;
    const Ground ground = Around(placed);
    const double height = (ground.high_m - ground.low_m) * ground.scale();
    std::string svg = SvgLine(ground.X(0) - 8, ground.Y(0), ground.X(0) + 8, ground.Y(0), "mark") +
                      SvgLine(ground.X(0), ground.Y(0) - 8, ground.X(0), ground.Y(0) + 8, "mark") +
                      SvgText(ground.X(0) + 6, ground.Y(0) + 18, "start", "hitch point") +
                      SvgLine(12, height - 12, 12 + ground.scale(), height - 12, "ruler") +
                      SvgText(12, height - 18, "start", "1 m");
    for (const Placed& camera : placed) svg += CameraSign(camera, ground);
    return "<figure class=\"map\">" + Svg(kWidth, height, "Cameras from above", svg) +
           "<figcaption>From above; the unit's front is to the right.</figcaption></figure>";
}

}  // namespace hitchview::app
