#pragma once

#include <Eigen/Core>

#include "drivers/simulated_paint.hpp"
#include "drivers/simulated_road.hpp"

namespace hitchview::drivers {

/// Lines of the road across, metres left of the driven lane.
struct RoadProfile {
    static constexpr double kRightEdge = -3.4;  ///< end of the shoulder
    static constexpr double kRightLine = -1.9;
    static constexpr double kMiddleLine = 1.8;
    static constexpr double kLeftLine = 5.5;
    static constexpr double kLeftEdge = 6.9;
    static constexpr double kPavement = 0.35;  ///< asphalt outside the outer lines
};

/// The plane z = 0: road, shoulders and grass, with or without snow, or one plain grey.
/// Thread-safe.
class Ground {
 public:
    Ground(const Palette& palette, const Road& road, SceneOptions::Ground kind, std::uint32_t seed);

    /// Mean colour of the area that one pixel sees: `across_m` wide at `p_world`, `along_m` long in
    /// the horizontal direction of sight `sight` (unit length).
    struct Patch {
        Eigen::Vector2d p_world;
        Eigen::Vector2f sight;
        float across_m, along_m;
    };
    [[nodiscard]] Colour ColourOf(const Patch& patch) const;

 private:
    /// A patch in coordinates of the road, with its extent in them.
    struct OnRoad {
        RoadPoint at;
        float along_m, across_m;
    };
    [[nodiscard]] OnRoad ToRoad(const Patch& patch) const;
    [[nodiscard]] float VariationAt(double repeat_m, const Patch& patch) const;
    [[nodiscard]] Colour Sampled(Paint paint, double repeat_m, const Patch& patch) const;
    [[nodiscard]] Colour Pavement(const Patch& patch, const OnRoad& road) const;
    [[nodiscard]] Colour Meadow(const Patch& patch) const;
    [[nodiscard]] Colour Plain(const Patch& patch) const;
    [[nodiscard]] Colour UnderSnow(const Colour& ground, const Patch& patch,
                                   const OnRoad& road) const;
    [[nodiscard]] float LineCover(const OnRoad& road) const;
    [[nodiscard]] float RepairCover(const OnRoad& road) const;

    const Palette& palette_;
    const Road& road_;
    SceneOptions::Ground kind_;
    std::uint32_t seed_;
};

}  // namespace hitchview::drivers
