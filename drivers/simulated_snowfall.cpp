#include "drivers/simulated_snowfall.hpp"

#include <algorithm>
#include <cmath>

#include "drivers/simulated_noise.hpp"

namespace hitchview::drivers {
namespace {

using Eigen::Vector2d;
using Eigen::Vector3d;

constexpr double kCell_m = 6;  // what falls repeats in cells of this size
constexpr double kNearest_m = 0.35;
constexpr double kWhite = 238;

/// A flake in the image: a line as long as it moved, with soft edges.
struct Streak {
    Vector2d from_px, to_px;
    double radius_px;
    double cover;  // of what lies behind its middle
};

double CoverAt(const Streak& streak, const Vector2d& pixel) {
    const Vector2d way = streak.to_px - streak.from_px;
    const double share =
        std::clamp((pixel - streak.from_px).dot(way) / std::max(way.squaredNorm(), 1e-9), 0.0, 1.0);
    const double distance_px = (pixel - streak.from_px - share * way).norm();
    return streak.cover * std::clamp(streak.radius_px + 0.5 - distance_px, 0.0, 1.0);
}

std::uint8_t Blend(std::uint8_t behind, double flake, double cover) {
    return static_cast<std::uint8_t>(
        std::clamp(behind + cover * (flake - behind) + 0.5, 0.0, 255.0));
}

void Draw(const Streak& streak, int width_px, int height_px, double white,
          std::span<std::uint8_t> nv12) {
    const double margin_px = streak.radius_px + 1;
    const Vector2d low = streak.from_px.cwiseMin(streak.to_px).array() - margin_px;
    const Vector2d high = streak.from_px.cwiseMax(streak.to_px).array() + margin_px;
    const int x_end = static_cast<int>(std::min(high.x() + 1, double(width_px)));
    const int y_end = static_cast<int>(std::min(high.y() + 1, double(height_px)));
    std::uint8_t* chroma = nv12.data() + static_cast<std::ptrdiff_t>(width_px) * height_px;
    for (int y = static_cast<int>(std::max(low.y(), 0.0)); y < y_end; ++y) {
        for (int x = static_cast<int>(std::max(low.x(), 0.0)); x < x_end; ++x) {
            const double cover = CoverAt(streak, {x, y});
            if (cover <= 0) continue;
            std::uint8_t& luma = nv12[static_cast<std::size_t>(y * width_px + x)];
            luma = Blend(luma, white, cover);
            if (y % 2 != 0 || x % 2 != 0) continue;
            std::uint8_t* uv = chroma + y / 2 * width_px + x;
            uv[0] = Blend(uv[0], 128, cover);
            uv[1] = Blend(uv[1], 128, cover);
        }
    }
}

/// Nearest copy of a place that repeats in every cell, relative to `centre_m`.
Vector3d Wrapped(const Vector3d& p_m, const Vector3d& centre_m) {
    const Vector3d apart = p_m - centre_m;
    return apart.unaryExpr([](double x) { return std::remainder(x, kCell_m); });
}

}  // namespace

Snowfall::Snowfall(int flakes, std::uint32_t seed) {
    Dice dice(seed);
    flakes_.reserve(static_cast<std::size_t>(flakes));
    for (int i = 0; i < flakes; ++i) {
        const Vector3d start_m{dice.Between(0, kCell_m), dice.Between(0, kCell_m),
                               dice.Between(0, kCell_m)};
        const Vector3d velocity_mps{dice.Between(-0.5, 0.5), dice.Between(-0.5, 0.5),
                                    dice.Between(-1.6, -0.9)};
        flakes_.push_back({start_m, velocity_mps, dice.Between(0.002, 0.006)});
    }
}

void Snowfall::DrawOver(const Shot& shot, std::span<std::uint8_t> nv12) const {
    const Vector3d eye = shot.T_world_camera.translation();
    const Eigen::Isometry3d T_end_world = shot.T_world_camera_end.inverse();
    const double white = std::min(kWhite * shot.gain, 255.0);
    for (const Flake& flake : flakes_) {
        const Vector3d p_world =
            eye + Wrapped(flake.start_m + shot.time_s * flake.velocity_mps, eye);
        const Vector3d p_camera = shot.T_world_camera.inverse() * p_world;
        const Vector3d p_end = T_end_world * (p_world + shot.open_s * flake.velocity_mps);
        if (p_world.z() < 0 || std::min(p_camera.z(), p_end.z()) < kNearest_m) continue;
        const auto from_px = shot.lens.Project(p_camera);
        const auto to_px = shot.lens.Project(p_end);
        if (!from_px || !to_px) continue;
        const double size_px = shot.lens.fx_px * flake.radius_m / p_camera.norm();
        const double drawn_px = std::max(size_px, 0.5);
        const double smear = 2 * drawn_px / (2 * drawn_px + (*to_px - *from_px).norm());
        Draw({*from_px, *to_px, drawn_px, size_px / drawn_px * std::sqrt(smear)},
             shot.lens.width_px, shot.lens.height_px, white, nv12);
    }
}

}  // namespace hitchview::drivers
