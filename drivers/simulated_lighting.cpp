#include "drivers/simulated_lighting.hpp"

#include <algorithm>
#include <cmath>

namespace hitchview::drivers {
namespace {

using Eigen::Vector3d;
using Eigen::Vector3f;

constexpr float kMoon = 0.09F;
constexpr float kTunnelFloor = 0.1F;  // light deep inside, between the lamps
constexpr double kTunnelDaylight_m = 3.5;
constexpr double kSlack = 0.05;  // the walls themselves are inside

/// A lamp on a unit that shines along x of its own frame, turned by `yaw_rad`.
struct Lamp {
    Vector3f p_unit;
    float yaw_rad;
    float level;           // close to it, in the middle of its beam
    float reach_m;         // distance at which half is left
    float half_width_rad;  // tangent, about
    float half_rise_rad;
};

constexpr float kQuarterTurn = 1.5708F;
const Lamp kHeadlight{{2, 0, 0.3F}, 0, 1.1F, 14, 0.5F, 0.09F};
const std::array kWorkLamps{Lamp{{-2.5F, 0, 1.2F}, 2 * kQuarterTurn, 0.7F, 8, 1.4F, 0.9F},
                            Lamp{{0, 0.7F, 1.2F}, kQuarterTurn, 0.6F, 9, 1.6F, 0.9F},
                            Lamp{{0, -0.7F, 1.2F}, -kQuarterTurn, 0.6F, 9, 1.6F, 0.9F}};

float Square(float x) {
    return x * x;
}

float LampAt(const Lamp& lamp, const Vector3f& p_unit) {
    const Vector3f to_p = p_unit - lamp.p_unit;
    const float c = std::cos(lamp.yaw_rad);
    const float s = std::sin(lamp.yaw_rad);
    const float ahead = c * to_p.x() + s * to_p.y();
    if (ahead <= 0.01F) return 0;
    const float aside = (c * to_p.y() - s * to_p.x()) / ahead;
    const float rise = to_p.z() / ahead;
    const float fall_rad = 4 * lamp.half_rise_rad;  // dipped beams light what lies below them
    const float beam = std::exp(-Square(aside / lamp.half_width_rad) -
                                Square(rise / (rise > 0 ? lamp.half_rise_rad : fall_rad)));
    return lamp.level * beam / (1 + to_p.squaredNorm() / Square(lamp.reach_m));
}

/// Of the nearest of lamps in a row; 1 right below it. Broad lamps: even beside them it is not
/// dark.
double LampRow(double along_m, double aside_m, double below_m, double spacing_m) {
    const double to_nearest_m = std::remainder(along_m, spacing_m);
    const double square = to_nearest_m * to_nearest_m + aside_m * aside_m;
    const double height = std::max(below_m, 2.0);
    return height * height / (height * height + square);
}

}  // namespace

Lighting::Lighting(const SceneOptions& scene, const Road& road)
    : night_(scene.night), tunnel_(scene.tunnel), road_(road) {}

float Lighting::LevelAt(const Vector3d& p_world, const Moment& moment) const {
    const float outside = tunnel_ ? TunnelAt(p_world) : 1.0F;
    if (!night_) return outside;
    const Vector3f p = p_world.cast<float>();
    const Vector3f p_trailer = moment.T_unit_world[algo::Unit::kTrailer] * p;
    float level = kMoon + StreetLampsAt(p_world) +
                  LampAt(kHeadlight, moment.T_unit_world[algo::Unit::kTractor] * p);
    for (const Lamp& lamp : kWorkLamps) level += LampAt(lamp, p_trailer);
    return level;
}

float Lighting::StreetLampsAt(const Vector3d& p_world) const {
    const RoadPoint at = road_.FromWorld(p_world.head<2>());
    double sum = 0;
    for (const StreetLampRow& row : kStreetLampRows) {
        const double share = LampRow(at.along_m - row.along_m, at.across_m - row.across_m,
                                     kStreetLampHeight_m - p_world.z(), kStreetLampSpacing_m);
        sum += share * std::sqrt(share);
    }
    return 0.75F * static_cast<float>(sum);
}

float Lighting::TunnelAt(const Vector3d& p_world) const {
    const double inside_m = std::min(p_world.x() - tunnel_->from_m, tunnel_->to_m - p_world.x());
    const bool in_profile = p_world.y() > TunnelProfile::kRight - kSlack &&
                            p_world.y() < TunnelProfile::kLeft + kSlack &&
                            p_world.z() < TunnelProfile::kHeight + kSlack;
    if (inside_m <= 0 || !in_profile) return 1;
    const double daylight = std::exp(-inside_m / kTunnelDaylight_m);
    const double middle_m = (TunnelProfile::kLeft + TunnelProfile::kRight) / 2;
    const double lamps = LampRow(p_world.x() - tunnel_->from_m, p_world.y() - middle_m,
                                 TunnelProfile::kHeight - p_world.z(), TunnelProfile::kLampSpacing);
    return static_cast<float>(daylight + (1 - daylight) * (kTunnelFloor + 0.3 * lamps));
}

}  // namespace hitchview::drivers
