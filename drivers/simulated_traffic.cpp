#include "drivers/simulated_traffic.hpp"

#include <algorithm>
#include <cmath>

#include "drivers/simulated_noise.hpp"

namespace hitchview::drivers {
namespace {

using Eigen::Vector3d;
using Eigen::Vector3f;

constexpr double kHalfLength_m = Traffic::kTruckLength_m / 2;
constexpr float kHalfWidth_m = 1.25F;
constexpr float kPicture_m = 6.2F;

/// A box with a picture over each side, repeated along a long one.
Solid Panel(const Vector3d& centre_m, const Vector3f& half_m, const std::array<Paint, 2>& paints,
            const Colour& tint) {
    const auto coat = [&](Paint paint, float width_m, float height_m) {
        return Coat{paint, std::min(2 * width_m, kPicture_m), 2 * height_m, 0.5F, 0, tint};
    };
    return {
        .shape = Shape::kBox,
        .centre_m = centre_m,
        .half_m = half_m,
        .coats = {coat(paints[0], half_m.y(), half_m.z()), coat(paints[1], half_m.x(), half_m.z()),
                  coat(Paint::kVariation, half_m.x(), half_m.y())}};
}

Solid Wheel(double x_m, double y_m) {
    const Coat rubber{.paint = Paint::kAsphalt, .tint = {0.4F, 0, 0}};
    return {.shape = Shape::kEllipsoid,
            .centre_m = {x_m, y_m, 0.5},
            .half_m = {0.5F, 0.17F, 0.5F},
            .coats = {rubber, rubber, rubber}};
}

Solid ShadowUnder() {
    constexpr double kMeanHeight_m = 1.6;
    const Eigen::Vector2d reach = -(kToSun.head<2>() / kToSun.z()).cast<double>() * kMeanHeight_m;
    return {.shape = Shape::kShadow,
            .centre_m = {reach.x(), reach.y(), 0},
            .half_m = {static_cast<float>(kHalfLength_m) + 1, kHalfWidth_m + 1, 0.01F}};
}

std::vector<Solid> TruckParts(Dice dice) {
    const Colour grey{0.5F, 0, 0};
    const Colour load{static_cast<float>(dice.Between(0.7, 1.0)),
                      static_cast<float>(dice.Between(-40, 40)),
                      static_cast<float>(dice.Between(-40, 40))};
    const Colour cab{1, static_cast<float>(dice.Between(-30, 30)),
                     static_cast<float>(dice.Between(-30, 30))};
    std::vector<Solid> parts{
        ShadowUnder(),
        Panel({-1.8, 0, 2.4}, {6.2F, kHalfWidth_m, 1.45F}, {Paint::kContainer, Paint::kContainer},
              load),
        Panel({-0.9, 0, 0.8}, {6.9F, 1, 0.15F}, {Paint::kMetal, Paint::kMetal}, grey),
        Panel({6.8, 0, 1.2}, {1.2F, 1.22F, 0.75F}, {Paint::kCarEnd, Paint::kCarSide}, cab),
        Panel({6.7, 0, 2.65}, {1.1F, 1.2F, 0.7F}, {Paint::kCarCabin, Paint::kCarCabin}, cab)};
    for (const double x_m : {6.9, 4.9, -4.4, -5.6, -6.8}) {
        parts.push_back(Wheel(x_m, kHalfWidth_m - 0.15));
        parts.push_back(Wheel(x_m, 0.15 - kHalfWidth_m));
    }
    return parts;
}

}  // namespace

Traffic::Traffic(const std::vector<SceneOptions::Truck>& trucks, const Road& road,
                 std::uint32_t seed)
    : road_(road) {
    for (const SceneOptions::Truck& truck : trucks) {
        trucks_.push_back(
            {truck, TruckParts(Dice(seed + static_cast<std::uint32_t>(trucks_.size())))});
    }
}

void Traffic::PlaceAt(double time_s, std::vector<Solid>& out) const {
    out.clear();
    for (const auto& [course, parts] : trucks_) {
        const Eigen::Vector2d middle =
            road_.ToWorld(course.start_m + course.speed_mps * time_s, course.across_m);
        const RoadPoint at = road_.FromWorld(middle);
        for (Solid part : parts) {
            const Vector3d p = part.centre_m;
            part.centre_m = {middle.x() + at.cos_heading * p.x() - at.sin_heading * p.y(),
                             middle.y() + at.sin_heading * p.x() + at.cos_heading * p.y(), p.z()};
            part.yaw_rad = std::atan2(at.sin_heading, at.cos_heading);
            out.push_back(part);
        }
    }
}

}  // namespace hitchview::drivers
