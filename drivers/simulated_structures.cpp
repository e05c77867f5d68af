#include "drivers/simulated_structures.hpp"

#include <cmath>

namespace hitchview::drivers {
namespace {

using Eigen::Vector3d;
using Eigen::Vector3f;
using Profile = TunnelProfile;

constexpr double kHillHalfWidth_m = 45;
constexpr double kHillTop_m = 9;
constexpr double kSignSpacing_m = 11;

Coat Repeating(Paint paint, float repeat_m, float light) {
    return {.paint = paint, .repeat_u_m = repeat_m, .repeat_v_m = repeat_m, .tint = {light, 0, 0}};
}

Solid Box(const Vector3d& low_m, const Vector3d& high_m, const std::array<Coat, 3>& coats) {
    return {.shape = Shape::kBox,
            .centre_m = (low_m + high_m) / 2,
            .half_m = ((high_m - low_m) / 2).cast<float>(),
            .coats = coats};
}

Solid GlowingBox(const Vector3d& centre_m, const Vector3f& half_m) {
    const Coat light{.paint = Paint::kVariation, .tint = {1.6F, -6, 4}};
    return {.shape = Shape::kBox,
            .centre_m = centre_m,
            .half_m = half_m,
            .coats = {light, light, light},
            .glows = true};
}

}  // namespace

void AppendTunnel(const SceneOptions::Tunnel& tunnel, std::vector<Solid>& out) {
    const Coat concrete = Repeating(Paint::kAsphalt, 6, 1.5F);
    const Coat tiles = Repeating(Paint::kBarrier, 5.5F, 1);
    const Coat meadow = Repeating(Paint::kGrass, 6, 1);
    const double from = tunnel.from_m;
    const double to = tunnel.to_m;
    const double middle_m = (Profile::kLeft + Profile::kRight) / 2;
    out.push_back(Box({from, Profile::kLeft, 0},
                      {to, Profile::kLeft + kHillHalfWidth_m, kHillTop_m},
                      {concrete, tiles, meadow}));
    out.push_back(Box({from, Profile::kRight - kHillHalfWidth_m, 0},
                      {to, Profile::kRight, kHillTop_m}, {concrete, tiles, meadow}));
    out.push_back(Box({from, Profile::kRight, Profile::kHeight}, {to, Profile::kLeft, kHillTop_m},
                      {concrete, concrete, meadow}));
    const Coat sign{Paint::kSign, 1.5F, 1.0F, 0.5F, 0, {1, 0, 0}};
    for (double x_m = from + 4; x_m < to; x_m += kSignSpacing_m) {
        for (const double y_m : {Profile::kRight + 0.05, Profile::kLeft - 0.05})
            out.push_back(
                Box({x_m, y_m - 0.04, 1.6}, {x_m + 1.5, y_m + 0.04, 2.6}, {sign, sign, sign}));
    }
    for (double x_m = from; x_m < to; x_m += Profile::kLampSpacing) {
        out.push_back(GlowingBox({x_m, middle_m, Profile::kHeight - 0.08}, {1.2F, 0.2F, 0.07F}));
    }
}

void AppendStreetLamps(const Road& road, double first_m, double last_m, std::vector<Solid>& out) {
    constexpr double kArm_m = 0.6;
    const Coat metal = Repeating(Paint::kMetal, 2, 1);
    for (const StreetLampRow& row : kStreetLampRows) {
        const double post_across_m = row.across_m + std::copysign(kArm_m, row.across_m);
        for (double along_m = first_m - std::remainder(first_m, kStreetLampSpacing_m) + row.along_m;
             along_m < last_m; along_m += kStreetLampSpacing_m) {
            const Eigen::Vector2d post = road.ToWorld(along_m, post_across_m);
            const Eigen::Vector2d lamp = road.ToWorld(along_m, row.across_m);
            out.push_back({.shape = Shape::kCylinder,
                           .centre_m = {post.x(), post.y(), kStreetLampHeight_m / 2},
                           .half_m = {0.08F, 0.08F, kStreetLampHeight_m / 2},
                           .coats = {metal, metal, metal}});
            out.push_back(
                GlowingBox({lamp.x(), lamp.y(), kStreetLampHeight_m}, {0.35F, 0.35F, 0.08F}));
        }
    }
}

void CoverWithSnow(std::vector<Solid>& solids) {
    const Coat snow = Repeating(Paint::kVariation, 9, 1.45F);
    for (Solid& solid : solids) {
        solid.coats[2] = snow;
        Coat& crown = solid.coats[0];
        if (crown.paint != Paint::kLeaves) continue;
        crown.paint = Paint::kGravel;
        crown.tint = crown.tint * 1.5F;
    }
}

}  // namespace hitchview::drivers
