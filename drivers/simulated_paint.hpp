#pragma once

#include <array>
#include <cstdint>
#include <vector>

#include "drivers/simulated_texture.hpp"

namespace hitchview::drivers {

/// What the things of the simulated world are covered with.
enum class Paint : std::uint8_t {
    kAsphalt,
    kGrass,
    kGravel,
    kVariation,  ///< slow changes of brightness, mean 128, no colour
    kBrickHouse,
    kPlasterHouse,
    kOffice,
    kWarehouse,
    kRoof,
    kCarSide,
    kCarEnd,
    kCarCabin,
    kCrate,
    kContainer,
    kBarrier,
    kBark,
    kLeaves,
    kMetal,
    kSign,
    kCount,
};

/// All paints, each once.
class Palette {
 public:
    /// `texels`: side of the largest textures, a power of two of at least 64.
    Palette(std::uint32_t seed, int texels);
    const Texture& operator[](Paint paint) const {
        return textures_[static_cast<std::size_t>(paint)];
    }

 private:
    std::vector<Texture> textures_;
};

}  // namespace hitchview::drivers
