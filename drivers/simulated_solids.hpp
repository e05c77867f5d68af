#pragma once

#include <Eigen/Core>
#include <Eigen/Geometry>
#include <array>
#include <cstdint>
#include <limits>
#include <vector>

#include "drivers/simulated_paint.hpp"

namespace hitchview::drivers {

/// Direction to the sun, world frame, unit length.
inline const Eigen::Vector3f kToSun = Eigen::Vector3f(0.55F, 0.45F, 0.70F).normalized();

enum class Shape : std::uint8_t {
    kBox,
    kCylinder,   ///< upright, radius half.x
    kEllipsoid,  ///< half axes
    kShadow,     ///< a flat, soft-edged rectangle on the ground; darkens, hides nothing
};

/// How one side of a solid is painted: texture coordinate = metres / repeat + offset.
struct Coat {
    Paint paint = Paint::kMetal;
    float repeat_u_m = 1, repeat_v_m = 1;
    float offset_u = 0, offset_v = 0;
    Colour tint{1, 0, 0};  ///< multiplies the light (y); adds chroma (u, v) in proportion to it
};

/// One thing of the world.
struct Solid {
    Shape shape = Shape::kBox;
    Eigen::Vector3d centre_m = Eigen::Vector3d::Zero();  ///< world frame
    Eigen::Vector3f half_m = Eigen::Vector3f::Ones();    ///< half lengths along its own axes
    double yaw_rad = 0;
    std::array<Coat, 3> coats{};  ///< sides facing x, sides facing y, top; others use the first
    bool glows = false;           ///< equally bright by day and night
};

/// A solid as seen from one eye: coordinates relative to the eye, world axes.
struct VisibleSolid {
    VisibleSolid(const Solid& solid, std::uint32_t solid_index, const Eigen::Vector3d& eye_world);

    [[nodiscard]] Eigen::Vector3f ToLocal(const Eigen::Vector3f& direction) const {
        return {cos_yaw * direction.x() + sin_yaw * direction.y(),
                cos_yaw * direction.y() - sin_yaw * direction.x(), direction.z()};
    }
    [[nodiscard]] Eigen::Vector3f ToWorld(const Eigen::Vector3f& local) const {
        return {cos_yaw * local.x() - sin_yaw * local.y(),
                cos_yaw * local.y() + sin_yaw * local.x(), local.z()};
    }

    std::uint32_t index;  ///< of the solid
    Shape shape;
    float cos_yaw, sin_yaw;
    Eigen::Vector3f centre_m;  ///< from the eye
    Eigen::Vector3f half_m;
    Eigen::Vector3f eye_m;  ///< the eye in axes of the solid, from its centre
    float nearest_m;        ///< no point of it is nearer
};

inline constexpr float kNoHit = std::numeric_limits<float>::infinity();

/// Where a ray enters a solid.
struct Entry {
    float distance_m = kNoHit;
    int face = 0;  ///< 0, 1: sides facing x; 2, 3: facing y; 4: bottom; 5: top; 6: round
};

/// `direction`: unit length, world axes. No entry from inside. A shadow has none.
Entry Intersect(const VisibleSolid& solid, const Eigen::Vector3f& direction);

/// Paint of a solid where a ray entered it, lit by the sun; `pixel_rad` is the angle that one pixel
/// sees.
Colour ShadeSolid(const Palette& palette, const Solid& solid, const VisibleSolid& visible,
                  const Eigen::Vector3f& direction, const Entry& entry, float pixel_rad);

/// Share of sunlight that a shadow takes from the point `p_m` of the ground, relative to the eye.
float ShadowAt(const VisibleSolid& shadow, const Eigen::Vector3f& p_m);

}  // namespace hitchview::drivers
