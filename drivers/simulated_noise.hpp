#pragma once

#include <algorithm>
#include <cstdint>

namespace hitchview::drivers {

/// Mixes the bits of `x`: neighbouring inputs give unrelated outputs.
constexpr std::uint32_t Hash(std::uint32_t x) {
    x = (x ^ (x >> 16)) * 0x7feb352dU;
    x = (x ^ (x >> 15)) * 0x846ca68bU;
    return x ^ (x >> 16);
}
constexpr std::uint32_t Hash(std::uint32_t x, std::uint32_t y) {
    return Hash(Hash(x) + y);
}
constexpr std::uint32_t Hash(std::uint32_t x, std::uint32_t y, std::uint32_t z) {
    return Hash(Hash(x, y) + z);
}

/// In [0, 1).
constexpr float Unit01(std::uint32_t hash) {
    return static_cast<float>(hash >> 8) * (1.0F / 16777216.0F);
}

/// A row of random numbers that depends on its seed alone.
class Dice {
 public:
    explicit constexpr Dice(std::uint32_t seed) : state_(Hash(seed)) {}

    constexpr std::uint32_t Next() { return Hash(state_ += 0x9e3779b9U); }
    constexpr double Between(double lowest, double highest) {
        return lowest + (highest - lowest) * Unit01(Next());
    }
    /// True with probability `chance`.
    constexpr bool Says(double chance) { return Unit01(Next()) < chance; }
    /// In 0..count-1.
    constexpr int Choose(int count) {
        return static_cast<int>(Next() % static_cast<std::uint32_t>(count));
    }

 private:
    std::uint32_t state_;
};

inline float SmoothStep(float low, float high, float x) {
    const float t = std::clamp((x - low) / (high - low), 0.0F, 1.0F);
    return t * t * (3 - 2 * t);
}

inline int Floor(float x) {
    const int i = static_cast<int>(x);
    return i - static_cast<int>(x < static_cast<float>(i));
}

/// Value noise in [0, 1], one lattice point per unit; repeats every `period` units in x and y.
inline float ValueNoise(float x, float y, int period, std::uint32_t seed) {
    const int x0 = Floor(x);
    const int y0 = Floor(y);
    const auto at = [&](int i, int j) {
        const auto wrap = [period](int k) {
            return static_cast<std::uint32_t>(((k % period) + period) % period);
        };
        return Unit01(Hash(seed, wrap(i), wrap(j)));
    };
    const float tx = SmoothStep(0, 1, x - static_cast<float>(x0));
    const float ty = SmoothStep(0, 1, y - static_cast<float>(y0));
    const float low = at(x0, y0) + (at(x0 + 1, y0) - at(x0, y0)) * tx;
    const float high = at(x0, y0 + 1) + (at(x0 + 1, y0 + 1) - at(x0, y0 + 1)) * tx;
    return low + (high - low) * ty;
}

/// Sum of `octaves` of value noise, each twice as fine and half as strong; in [0, 1].
inline float FractalNoise(float x, float y, int period, int octaves, std::uint32_t seed) {
    float sum = 0;
    float weight = 0.5F;
    float total = 0;
    for (int i = 0; i < octaves; ++i) {
        sum += weight * ValueNoise(x, y, period, seed + static_cast<std::uint32_t>(i));
        total += weight;
        weight *= 0.5F;
        x *= 2;
        y *= 2;
        period *= 2;
    }
    return sum / total;
}

}  // namespace hitchview::drivers
