#include "drivers/simulated_world.hpp"

#include <algorithm>
#include <bit>

#include "drivers/simulated_noise.hpp"
#include "drivers/simulated_placement.hpp"

namespace hitchview::drivers {
namespace {

using Eigen::Vector3d;
using Eigen::Vector3f;

constexpr float kGroundEnd_m = 2500;  // the plane beyond is less than a pixel high

double Route_m(const SimulationOptions& o) {
    double fastest_mps = o.speed_mps;
    for (const Key& key : o.speed) fastest_mps = std::max(fastest_mps, key.value);
    return fastest_mps * std::chrono::duration<double>(FrameTime(o, o.frames)).count();
}

/// Textures about as fine as the pixels need: smaller images are made sooner.
int PaintTexels(const SimulationOptions& o) {
    return o.width_px > 800 ? 512 : o.width_px > 400 ? 256 : 128;
}

int BackdropTexels(const SimulationOptions& o) {
    return static_cast<int>(std::bit_ceil(static_cast<unsigned>(3 * o.width_px)));
}

bool Fills(const VisibleSolid& solid, float smallest_rad) {
    const float radius_m = solid.half_m.norm();
    return radius_m > smallest_rad * solid.nearest_m;
}

}  // namespace

World::World(const SimulationOptions& options, std::span<const Eigen::Vector2d> driven)
    : palette_(Hash(options.seed, 1), PaintTexels(options)),
      road_(options),
      ground_(palette_, road_, options.scene.ground, Hash(options.seed, 2)),
      backdrop_(Hash(options.seed, 3), BackdropTexels(options)),
      lighting_(options.scene, road_),
      traffic_(options.scene.trucks, road_, Hash(options.seed, 5)),
      solids_(PlaceSolids(road_, {Route_m(options), options.scene, driven}, Hash(options.seed, 4))),
      haze_half_m_(static_cast<float>(options.scene.visibility_m)),
      overcast_(static_cast<float>(options.scene.overcast)),
      sunlight_(lighting_.sky() * (1 - 0.8F * overcast_)),
      air_(kHaze * lighting_.sky()) {}

void World::Look(const Vector3d& eye_world, const Moment& moment, float smallest_rad,
                 Surroundings& out) const {
    out.eye_world = eye_world;
    out.moment = moment;
    traffic_.PlaceAt(moment.time_s, out.moving);
    const std::size_t count = solids_.size() + out.moving.size();
    out.solids.clear();
    out.solids.reserve(count);
    for (std::size_t i = 0; i < count; ++i) {
        const auto index = static_cast<std::uint32_t>(i);
        const VisibleSolid solid(SolidOf(out, index), index, eye_world);
        if (Fills(solid, smallest_rad)) out.solids.push_back(solid);
    }
    std::sort(out.solids.begin(), out.solids.end(), [](const auto& a, const auto& b) {
        return a.nearest_m != b.nearest_m ? a.nearest_m < b.nearest_m : a.index < b.index;
    });
}

Hit World::Cast(const Surroundings& around, std::span<const std::uint32_t> nearby,
                const Vector3f& direction) {
    Hit hit;
    const float ground_m = -static_cast<float>(around.eye_world.z()) / direction.z();
    if (direction.z() < 0 && ground_m < kGroundEnd_m) hit = {ground_m, Hit::kGround, 0};
    for (const std::uint32_t i : nearby) {
        const VisibleSolid& solid = around.solids[i];
        if (solid.nearest_m > hit.distance_m) break;
        const Entry entry = Intersect(solid, direction);
        if (entry.distance_m < hit.distance_m) {
            hit = {entry.distance_m, static_cast<std::int32_t>(i), entry.face};
        }
    }
    return hit;
}

Colour World::ThroughAir(const Colour& colour, float distance_m) const {
    return Mix(colour, air_, distance_m / (distance_m + haze_half_m_));
}

/// `p_m`: relative to the eye.
float World::LightAt(const Surroundings& around, const Vector3f& p_m) const {
    if (lighting_.plain_daylight()) return 1;
    return lighting_.LevelAt(around.eye_world + p_m.cast<double>(), around.moment);
}

Colour World::ColourOf(const Surroundings& around, std::span<const std::uint32_t> nearby,
                       const Vector3f& direction, const Hit& hit, float pixel_rad) const {
    if (hit.what == Hit::kSky) {
        const Colour far = backdrop_.ColourOf(direction, pixel_rad) * lighting_.sky();
        return overcast_ > 0 ? Mix(far, air_, overcast_) : far;
    }
    if (hit.what == Hit::kGround) {
        return GroundColour(around, nearby, direction, hit.distance_m, pixel_rad);
    }
    return SolidColour(around, direction, hit, pixel_rad);
}

Colour World::SolidColour(const Surroundings& around, const Vector3f& direction, const Hit& hit,
                          float pixel_rad) const {
    const VisibleSolid& visible = around.solids[static_cast<std::size_t>(hit.what)];
    const Solid& solid = SolidOf(around, visible.index);
    const Colour colour =
        ShadeSolid(palette_, solid, visible, direction, {hit.distance_m, hit.face}, pixel_rad);
    const float light = solid.glows ? 1.0F : LightAt(around, hit.distance_m * direction);
    return ThroughAir(colour * light, hit.distance_m);
}

Colour World::GroundColour(const Surroundings& around, std::span<const std::uint32_t> nearby,
                           const Vector3f& direction, float distance_m, float pixel_rad) const {
    const Vector3f p_m = distance_m * direction;
    const float across_m = distance_m * pixel_rad;
    const Colour colour =
        ground_.ColourOf({around.eye_world.head<2>() + p_m.head<2>().cast<double>(),
                          direction.head<2>().normalized(), across_m, across_m / -direction.z()});
    float shadow = 0;
    for (const std::uint32_t i : nearby) {
        const VisibleSolid& solid = around.solids[i];
        if (solid.nearest_m > distance_m) break;
        if (solid.shape == Shape::kShadow) shadow = std::max(shadow, ShadowAt(solid, p_m));
    }
    const float light = LightAt(around, p_m) * (1 - shadow * sunlight_);
    return ThroughAir(colour * light, distance_m);
}

}  // namespace hitchview::drivers
