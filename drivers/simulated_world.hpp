#pragma once

#include <Eigen/Core>
#include <cstdint>
#include <span>
#include <vector>

#include "drivers/simulated_backdrop.hpp"
#include "drivers/simulated_ground.hpp"
#include "drivers/simulated_lighting.hpp"
#include "drivers/simulated_options.hpp"
#include "drivers/simulated_road.hpp"
#include "drivers/simulated_solids.hpp"
#include "drivers/simulated_traffic.hpp"

namespace hitchview::drivers {

/// What one eye has around it at one moment.
struct Surroundings {
    Eigen::Vector3d eye_world = Eigen::Vector3d::Zero();
    Moment moment;
    std::vector<Solid> moving;         ///< numbered on from those that stand
    std::vector<VisibleSolid> solids;  ///< sorted from near to far
};

/// What a ray meets first.
struct Hit {
    static constexpr std::int32_t kGround = -1;
    static constexpr std::int32_t kSky = -2;

    float distance_m = kNoHit;
    std::int32_t what = kSky;  ///< kGround, kSky, or position in Surroundings::solids
    int face = 0;              ///< of a solid

    /// Differs between neighbouring pixels where an edge runs between them.
    [[nodiscard]] std::int32_t surface() const { return what < 0 ? what : what * 8 + face; }
};

/// The scene that the vehicle drives through. Deterministic by its options. Thread-safe.
class World {
 public:
    /// Nothing stands within some metres of the places in `driven`, which lie off the road.
    World(const SimulationOptions& options, std::span<const Eigen::Vector2d> driven);
    World(const World&) = delete;
    World& operator=(const World&) = delete;

    /// Every solid that may fill `smallest_rad` or more of the view from `eye_world`.
    void Look(const Eigen::Vector3d& eye_world, const Moment& moment, float smallest_rad,
              Surroundings& out) const;

    /// First thing on the ray from the eye along `direction` (unit length, world axes) among the
    /// solids numbered in `nearby`, ascending.
    [[nodiscard]] static Hit Cast(const Surroundings& around, std::span<const std::uint32_t> nearby,
                                  const Eigen::Vector3f& direction);
    /// Colour of a hit of Cast with the same arguments.
    [[nodiscard]] Colour ColourOf(const Surroundings& around, std::span<const std::uint32_t> nearby,
                                  const Eigen::Vector3f& direction, const Hit& hit,
                                  float pixel_rad) const;

    [[nodiscard]] const Lighting& lighting() const { return lighting_; }

 private:
    [[nodiscard]] const Solid& SolidOf(const Surroundings& around, std::uint32_t index) const {
        return index < solids_.size() ? solids_[index] : around.moving[index - solids_.size()];
    }
    [[nodiscard]] Colour SolidColour(const Surroundings& around, const Eigen::Vector3f& direction,
                                     const Hit& hit, float pixel_rad) const;
    [[nodiscard]] Colour ThroughAir(const Colour& colour, float distance_m) const;
    [[nodiscard]] float LightAt(const Surroundings& around, const Eigen::Vector3f& p_m) const;
    [[nodiscard]] Colour GroundColour(const Surroundings& around,
                                      std::span<const std::uint32_t> nearby,
                                      const Eigen::Vector3f& direction, float distance_m,
                                      float pixel_rad) const;

    Palette palette_;
    Road road_;
    Ground ground_;
    Backdrop backdrop_;
    Lighting lighting_;
    Traffic traffic_;
    std::vector<Solid> solids_;
    float haze_half_m_;
    float overcast_;
    float sunlight_;  // share that throws shadows
    Colour air_;      // what far things fade into
};

}  // namespace hitchview::drivers
