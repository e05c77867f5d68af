#pragma once

#include <cstdint>
#include <functional>
#include <vector>

namespace hitchview::drivers {

/// Full-range luma (0..255) and chroma centred on zero, BT.601 as in JPEG. Scaling a colour darkens
/// it: all three are linear in red, green and blue.
struct Colour {
    float y = 0, u = 0, v = 0;

    Colour& operator+=(const Colour& b) { return *this = {y + b.y, u + b.u, v + b.v}; }
    friend Colour operator+(Colour a, const Colour& b) { return a += b; }
    friend Colour operator*(const Colour& a, float k) { return {a.y * k, a.u * k, a.v * k}; }
};

inline Colour Mix(const Colour& a, const Colour& b, float share_of_b) {
    return a * (1 - share_of_b) + b * share_of_b;
}

/// Red, green and blue in 0..255.
constexpr Colour FromRgb(float r, float g, float b) {
    return {0.299F * r + 0.587F * g + 0.114F * b, -0.168736F * r - 0.331264F * g + 0.5F * b,
            0.5F * r - 0.418688F * g - 0.081312F * b};
}

/// A picture that repeats in both directions, with all its smaller versions. Thread-safe.
class Texture {
 public:
    /// Colour at (u, v) in [0, 1), v upwards.
    using Painter = std::function<Colour(float u, float v)>;

    /// `width`, `height`: powers of two, in texels.
    Texture(int width, int height, const Painter& paint);

    /// Filtered over the area seen. `footprint`: its width, as a share of the texture's width.
    [[nodiscard]] Colour Sample(float u, float v, float footprint) const;

 private:
    struct Level {
        [[nodiscard]] Colour Sample(float u, float v) const;  // bilinear

        int width = 0, height = 0;
        std::vector<std::uint32_t> texels;  // y, u + 128, v + 128 in the three low bytes
    };
    static Level Pack(int width, int height, const std::vector<Colour>& colours);

    std::vector<Level> levels_;
};

}  // namespace hitchview::drivers
