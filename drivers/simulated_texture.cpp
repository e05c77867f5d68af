#include "drivers/simulated_texture.hpp"

#include <algorithm>
#include <bit>

#include "hal/expect.hpp"

namespace hitchview::drivers {
namespace {

std::uint32_t Byte(float value) {
    return static_cast<std::uint32_t>(std::clamp(value + 0.5F, 0.0F, 255.0F));
}

std::vector<Colour> Halved(int width, int height, const std::vector<Colour>& colours) {
    std::vector<Colour> half;
    half.reserve(colours.size() / 4);
    for (int y = 0; y < height; y += 2) {
        for (int x = 0; x < width; x += 2) {
            const auto i = static_cast<std::size_t>(y) * static_cast<std::size_t>(width) +
                           static_cast<std::size_t>(x);
            const auto below = i + static_cast<std::size_t>(width);
            half.push_back((colours[i] + colours[i + 1] + colours[below] + colours[below + 1]) *
                           0.25F);
        }
    }
    return half;
}

/// log2 for x >= 1, exact at powers of two and straight between them.
float RoughLog2(float x) {
    const auto bits = std::bit_cast<std::uint32_t>(x);
    return static_cast<float>(bits) * (1.0F / 8388608.0F) - 127.0F;
}

}  // namespace

Texture::Texture(int width, int height, const Painter& paint) {
    HV_EXPECT(std::has_single_bit(static_cast<unsigned>(width)) &&
              std::has_single_bit(static_cast<unsigned>(height)));
    std::vector<Colour> colours;
    colours.reserve(static_cast<std::size_t>(width) * static_cast<std::size_t>(height));
    for (int y = 0; y < height; ++y) {
        for (int x = 0; x < width; ++x) {
            colours.push_back(paint((static_cast<float>(x) + 0.5F) / static_cast<float>(width),
                                    (static_cast<float>(y) + 0.5F) / static_cast<float>(height)));
        }
    }
    levels_.push_back(Pack(width, height, colours));
    while (width > 1 && height > 1) {
        colours = Halved(width, height, colours);
        width /= 2;
        height /= 2;
        levels_.push_back(Pack(width, height, colours));
    }
}

Texture::Level Texture::Pack(int width, int height, const std::vector<Colour>& colours) {
    Level level{width, height, {}};
    level.texels.reserve(colours.size());
    for (const Colour& c : colours) {
        level.texels.push_back(Byte(c.y) | Byte(c.u + 128) << 8 | Byte(c.v + 128) << 16);
    }
    return level;
}

// Weighted mean of four texels. Two channels share one word, 16 bits each; weights sum to 256.
inline Colour Texture::Level::Sample(float u, float v) const {
    const int x = static_cast<int>(u * static_cast<float>(width * 256)) - 128;
    const int y = static_cast<int>(v * static_cast<float>(height * 256)) - 128;
    const int x0 = (x >> 8) & (width - 1);
    const int x1 = (x0 + 1) & (width - 1);
    const int row0 = ((y >> 8) & (height - 1)) * width;
    const int row1 = (((y >> 8) + 1) & (height - 1)) * width;
    const std::uint32_t wx = static_cast<std::uint32_t>(x) & 255U;
    const std::uint32_t wy = static_cast<std::uint32_t>(y) & 255U;
    const std::uint32_t w11 = (wx * wy) >> 8;
    const std::uint32_t w10 = wx - w11;
    const std::uint32_t w01 = wy - w11;
    const std::uint32_t w00 = 256 - wx - wy + w11;
    const auto texel = [this](int i) { return texels[static_cast<std::size_t>(i)]; };
    const std::uint32_t a = texel(row0 + x0), b = texel(row0 + x1);
    const std::uint32_t c = texel(row1 + x0), d = texel(row1 + x1);
    constexpr std::uint32_t kEven = 0x00ff00ffU;
    const std::uint32_t yv =
        (a & kEven) * w00 + (b & kEven) * w10 + (c & kEven) * w01 + (d & kEven) * w11;
    const std::uint32_t u_only = ((a >> 8) & 255U) * w00 + ((b >> 8) & 255U) * w10 +
                                 ((c >> 8) & 255U) * w01 + ((d >> 8) & 255U) * w11;
    constexpr float kScale = 1.0F / 256.0F;
    return {static_cast<float>(yv & 0xffffU) * kScale, static_cast<float>(u_only) * kScale - 128,
            static_cast<float>(yv >> 16) * kScale - 128};
}

Colour Texture::Sample(float u, float v, float footprint) const {
    const auto coarsest = static_cast<float>(levels_.size() - 1);
    const float texels = std::max(footprint * static_cast<float>(levels_[0].width), 1.0F);
    const float at = std::min(RoughLog2(texels), coarsest);
    const auto fine = static_cast<std::size_t>(at);
    // Near a level that level serves alone; between two they fade into each other.
    const float share = std::clamp(2 * (at - static_cast<float>(fine)) - 0.5F, 0.0F, 1.0F);
    if (share <= 0) return levels_[fine].Sample(u, v);
    if (share >= 1) return levels_[fine + 1].Sample(u, v);
    return Mix(levels_[fine].Sample(u, v), levels_[fine + 1].Sample(u, v), share);
}

}  // namespace hitchview::drivers
