#pragma once

#include <array>
#include <cmath>
#include <cstdint>
#include <numbers>
#include <opencv2/core.hpp>

namespace hitchview::tests {

/// A grey world without end: waves in random directions, known at every point of the plane, so that
/// pictures of it can be taken with any motion in between and no resampling.
class SineTexture {
 public:
    /// Lengths of the waves lie between the two.
    explicit SineTexture(std::uint64_t seed, double shortest_px = 12, double longest_px = 48) {
        cv::RNG random(seed);
        for (Wave& wave : waves_) {
            const double length_px =
                shortest_px * std::pow(longest_px / shortest_px, random.uniform(0.0, 1.0));
            const double direction = random.uniform(0.0, std::numbers::pi);
            wave = {2 * std::numbers::pi / length_px * std::cos(direction),
                    2 * std::numbers::pi / length_px * std::sin(direction),
                    random.uniform(0.0, 2 * std::numbers::pi)};
        }
    }

    /// Grey level at a point, 128 +- 35 (one standard deviation).
    [[nodiscard]] double At(double x, double y) const {
        double sum = 0;
        for (const Wave& wave : waves_) sum += std::sin(wave.fx * x + wave.fy * y + wave.phase);
        return 128 + kAmplitude * sum;
    }

    /// The picture whose pixel (x, y) shows the point point_of(x, y) of the world.
    template <typename PointOf>
    [[nodiscard]] cv::Mat1b Picture(cv::Size size, PointOf&& point_of) const {
        cv::Mat1b picture(size);
        for (int y = 0; y < size.height; ++y) {
            for (int x = 0; x < size.width; ++x) {
                const auto point = point_of(x, y);
                picture(y, x) = cv::saturate_cast<std::uint8_t>(At(point[0], point[1]));
            }
        }
        return picture;
    }

    /// What lies at p in the unshifted picture lies at p + (dx, dy) in this one.
    [[nodiscard]] cv::Mat1b Shifted(cv::Size size, double dx, double dy) const {
        return Picture(size, [&](int x, int y) { return cv::Vec2d(x - dx, y - dy); });
    }

 private:
    static constexpr int kWaves = 24;
    static constexpr double kAmplitude = 10;
    struct Wave {
        double fx, fy, phase;
    };
    std::array<Wave, kWaves> waves_{};
};

}  // namespace hitchview::tests
