#include "drivers/simulated_backdrop.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>

#include "drivers/simulated_noise.hpp"
#include "drivers/simulated_solids.hpp"

namespace hitchview::drivers {
namespace {

constexpr float kTwoPi = 2 * std::numbers::pi_v<float>;
constexpr float kLowest_rad = -0.04F;
constexpr float kSpan_rad = kTwoPi / 8;  // as many texels per radian upwards as around
constexpr int kWidthOfHeight = 8;
constexpr float kBorder = 0.01F;  // share of the picture at its lower and upper edge

/// Share of a texel at `elevation_rad` that lies below `top_rad`.
float EdgeCover(float top_rad, float elevation_rad, float texel_rad) {
    return std::clamp((top_rad - elevation_rad) / texel_rad + 0.5F, 0.0F, 1.0F);
}

float Ridge(float turn, int waves, float low_rad, float high_rad, std::uint32_t seed) {
    const float noise = FractalNoise(turn * static_cast<float>(waves), 0.5F, waves, 6, seed);
    return low_rad + (high_rad - low_rad) * noise;
}

Colour Sky(float turn, float elevation_rad, std::uint32_t seed) {
    const float up = std::max(elevation_rad, 0.0F);
    const Colour clear = Mix(kHaze, FromRgb(74, 128, 196), SmoothStep(0.0F, 0.75F, up));
    const float spread = 1.6F / (std::sin(up) + 0.12F);  // a flat layer of clouds
    const float x = std::cos(turn * kTwoPi) * spread + 64;
    const float y = std::sin(turn * kTwoPi) * spread + 64;
    const float density = FractalNoise(x, y, 4096, 6, seed);
    const float cover = SmoothStep(0.47F, 0.63F, density) * SmoothStep(0.0F, 0.12F, up);
    if (cover <= 0) return clear;
    const float lit = FractalNoise(x + 0.12F, y + 0.1F, 4096, 5, seed);  // towards the sun
    const float light = 232 + 190 * (density - lit) - 40 * SmoothStep(0.6F, 0.8F, density);
    return Mix(clear, FromRgb(light, light, light * 1.01F), cover * 0.92F);
}

struct Hills {
    int waves;
    float low_rad, high_rad;
    Colour dark, bright;
    int trees;  // patches of wood around the circle
};

/// From near to far.
constexpr std::array kHills{
    Hills{24, 0.004F, 0.05F, FromRgb(40, 66, 38), FromRgb(112, 134, 74), 1100},
    Hills{14, 0.01F, 0.1F, FromRgb(78, 104, 104), FromRgb(132, 150, 132), 700},
    Hills{9, 0.03F, 0.16F, FromRgb(120, 142, 168), FromRgb(146, 164, 184), 400},
};

/// Blocks of a town with lit and dark windows; share of the picture they cover in `cover`.
Colour Town(float turn, float elevation_rad, float texel_rad, std::uint32_t seed, float& cover) {
    constexpr int kBlocks = 320;
    const float at = turn * kBlocks;
    const auto block = static_cast<std::uint32_t>(at);
    const float density = ValueNoise(turn * 7, 0, 7, seed);
    const bool built = Unit01(Hash(seed, block)) < 1.8F * (density - 0.3F);
    const float top_rad = 0.03F + 0.075F * density * Unit01(Hash(seed, block, 5));
    cover = built ? EdgeCover(top_rad, elevation_rad, texel_rad) : 0.0F;
    const float x = (at - std::floor(at)) * 6;
    const float y = elevation_rad * 400;
    const bool window = x - std::floor(x) > 0.4F && y - std::floor(y) > 0.45F;
    const float wall = 110 + 70 * Unit01(Hash(seed, block, 9));
    const float light =
        window ? wall * (0.55F + 0.3F * Unit01(Hash(block, static_cast<std::uint32_t>(y + 64),
                                                    static_cast<std::uint32_t>(x))))
               : wall;
    return FromRgb(light, light * 1.01F, light * 1.05F);
}

Colour HillSide(const Hills& hills, float turn, float elevation_rad, std::uint32_t seed) {
    const auto trees = static_cast<float>(hills.trees);
    const float wood = FractalNoise(turn * trees, elevation_rad * trees / kTwoPi * 1.5F + 32,
                                    hills.trees, 3, seed);
    const Colour side = Mix(hills.dark, hills.bright, SmoothStep(0.3F, 0.7F, wood));
    return Mix(side, kHaze, 0.35F * (1 - SmoothStep(-0.01F, 0.04F, elevation_rad)));
}

/// Layers laid over each other, nearest first, until nothing shows through.
class Layers {
 public:
    void Add(const Colour& colour, float cover) {
        sum_ += colour * (cover * shows_through_);
        shows_through_ *= 1 - cover;
    }
    [[nodiscard]] bool opaque() const { return shows_through_ <= 0; }
    [[nodiscard]] const Colour& sum() const { return sum_; }

 private:
    Colour sum_;
    float shows_through_ = 1;
};

void AddHills(std::size_t i, float turn, float elevation_rad, float texel_rad, std::uint32_t seed,
              Layers& layers) {
    const Hills& hills = kHills[i];
    if (layers.opaque() || elevation_rad > hills.high_rad + texel_rad) return;
    const std::uint32_t own_seed = Hash(seed, 10, static_cast<std::uint32_t>(i));
    const float top_rad = Ridge(turn, hills.waves, hills.low_rad, hills.high_rad, own_seed);
    const float cover = EdgeCover(top_rad, elevation_rad, texel_rad);
    if (cover > 0) layers.Add(HillSide(hills, turn, elevation_rad, own_seed), cover);
}

Colour PaintBackdrop(float turn, float elevation_rad, float texel_rad, std::uint32_t seed) {
    Layers layers;
    AddHills(0, turn, elevation_rad, texel_rad, seed, layers);
    float built = 0;
    const Colour town = Town(turn, elevation_rad, texel_rad, Hash(seed, 2), built);
    layers.Add(town, built);
    AddHills(1, turn, elevation_rad, texel_rad, seed, layers);
    AddHills(2, turn, elevation_rad, texel_rad, seed, layers);
    if (!layers.opaque()) layers.Add(Sky(turn, elevation_rad, Hash(seed, 1)), 1);
    return layers.sum();
}

}  // namespace

Backdrop::Backdrop(std::uint32_t seed, int texels)
    : picture_(texels, texels / kWidthOfHeight, [&](float u, float v) {
          return PaintBackdrop(u, kLowest_rad + v * kSpan_rad, kTwoPi / static_cast<float>(texels),
                               seed);
      }) {}

Colour Backdrop::ColourOf(const Eigen::Vector3f& direction, float pixel_rad) const {
    const float turn = std::atan2(direction.y(), direction.x()) / kTwoPi;
    const float elevation = std::asin(std::clamp(direction.z(), -1.0F, 1.0F));
    const float height = std::clamp((elevation - kLowest_rad) / kSpan_rad, kBorder, 1 - kBorder);
    return picture_.Sample(turn, height, pixel_rad / kTwoPi);
}

}  // namespace hitchview::drivers
