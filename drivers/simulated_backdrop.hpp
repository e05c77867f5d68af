#pragma once

#include <Eigen/Core>
#include <cstdint>

#include "drivers/simulated_texture.hpp"

namespace hitchview::drivers {

/// Colour of the air just above the horizon, which far things fade into.
inline constexpr Colour kHaze = FromRgb(186, 200, 210);

/// What is infinitely far away: sky, clouds, hills and a skyline. Thread-safe.
class Backdrop {
 public:
    /// `texels`: around the full circle, a power of two.
    Backdrop(std::uint32_t seed, int texels);

    /// `direction`: unit length, world frame.
    [[nodiscard]] Colour ColourOf(const Eigen::Vector3f& direction, float pixel_rad) const;

 private:
    Texture picture_;
};

}  // namespace hitchview::drivers
