#include "drivers/simulated_drops.hpp"

#include <algorithm>
#include <cmath>

#include "drivers/simulated_noise.hpp"

namespace hitchview::drivers {
namespace {

using Eigen::Vector2d;
using Eigen::Vector3d;

constexpr double kSmallest = 0.008;  // radius, of the picture's width
constexpr double kLargest = 0.045;
constexpr double kRunning = 0.15;  // share of the drops
constexpr double kSlowest = 0.04;  // of those, picture heights per second
constexpr double kFastest = 0.25;
constexpr double kSoft = 0.35;   // of the radius: the edge is out of focus
constexpr double kSeen = 5;      // radii of the scene that a drop's half shows
constexpr double kRim = 0.3;     // light that is lost at the edge
constexpr int kBlurTexels = 40;  // along the width of the blurred picture

std::uint8_t Mixed(std::uint8_t behind, double drop, double cover) {
    return static_cast<std::uint8_t>(
        std::clamp(behind + cover * (drop - behind) + 0.5, 0.0, 255.0));
}

}  // namespace

struct LensDrops::Blurred {
    int side_px = 1;  ///< of a texel; even
    int columns = 0;
    int rows = 0;
    std::vector<Vector3d> texels;  ///< Y, U, V

    [[nodiscard]] Vector3d At(const Vector2d& pixel) const {
        const Vector2d at = (pixel.array() + 0.5) / side_px - 0.5;
        const int x = std::clamp(static_cast<int>(std::floor(at.x())), 0, columns - 2);
        const int y = std::clamp(static_cast<int>(std::floor(at.y())), 0, rows - 2);
        const double u = std::clamp(at.x() - x, 0.0, 1.0);
        const double v = std::clamp(at.y() - y, 0.0, 1.0);
        const Vector3d* upper = texels.data() + y * columns + x;
        const Vector3d* lower = upper + columns;
        return (1 - v) * ((1 - u) * upper[0] + u * upper[1]) +
               v * ((1 - u) * lower[0] + u * lower[1]);
    }
};

LensDrops::LensDrops(int drops, int width_px, int height_px, std::uint32_t seed)
    : drops_(drops), width_px_(width_px), height_px_(height_px), seed_(seed) {}

void LensDrops::DrawOver(int camera_index, double time_s, std::span<std::uint8_t> nv12) const {
    const Blurred behind = Reduce(nv12);
    for (const Drop& drop : DropsAt(camera_index, time_s)) Draw(drop, behind, nv12);
}

/// Those that run leave at the bottom and come again from above.
std::vector<LensDrops::Drop> LensDrops::DropsAt(int camera_index, double time_s) const {
    Dice dice(Hash(seed_, static_cast<std::uint32_t>(camera_index)));
    std::vector<Drop> drops;
    for (int i = 0; i < drops_; ++i) {
        const double size = dice.Between(0, 1);
        const double radius_px =
            width_px_ * (kSmallest + (kLargest - kSmallest) * size * size * size);
        Vector2d centre_px(dice.Between(0, width_px_), dice.Between(0, height_px_));
        const bool runs = dice.Says(kRunning);
        const double pace = dice.Between(kSlowest, kFastest);
        if (runs) {
            const double way_px = height_px_ + 4 * radius_px;
            const double run_px = centre_px.y() + pace * height_px_ * time_s;
            centre_px.y() = std::fmod(run_px, way_px) - 2 * radius_px;
        }
        drops.push_back({centre_px, radius_px});
    }
    return drops;
}

LensDrops::Blurred LensDrops::Reduce(std::span<const std::uint8_t> nv12) const {
    Blurred blurred;
    blurred.side_px = std::max(2, width_px_ / kBlurTexels / 2 * 2);
    blurred.columns = std::max(2, width_px_ / blurred.side_px);
    blurred.rows = std::max(2, height_px_ / blurred.side_px);
    const std::uint8_t* chroma = nv12.data() + static_cast<std::ptrdiff_t>(width_px_) * height_px_;
    for (int row = 0; row < blurred.rows; ++row) {
        for (int column = 0; column < blurred.columns; ++column) {
            Vector3d sum = Vector3d::Zero();
            for (int y = row * blurred.side_px; y < (row + 1) * blurred.side_px; ++y) {
                for (int x = column * blurred.side_px; x < (column + 1) * blurred.side_px; ++x) {
                    const int y_in = std::min(y, height_px_ - 1);
                    const int x_in = std::min(x, width_px_ - 1);
                    const std::uint8_t* uv = chroma + y_in / 2 * width_px_ + x_in / 2 * 2;
                    sum += Vector3d(nv12[static_cast<std::size_t>(y_in * width_px_ + x_in)], uv[0],
                                    uv[1]);
                }
            }
            blurred.texels.emplace_back(sum / (blurred.side_px * blurred.side_px));
        }
    }
    return blurred;
}

void LensDrops::Draw(const Drop& drop, const Blurred& behind, std::span<std::uint8_t> nv12) const {
    const Vector2d low = drop.centre_px.array() - drop.radius_px;
    const Vector2d high = drop.centre_px.array() + drop.radius_px;
    const int x_end = std::min(static_cast<int>(high.x()) + 1, width_px_);
    const int y_end = std::min(static_cast<int>(high.y()) + 1, height_px_);
    std::uint8_t* chroma = nv12.data() + static_cast<std::ptrdiff_t>(width_px_) * height_px_;
    for (int y = std::max(static_cast<int>(low.y()), 0); y < y_end; ++y) {
        for (int x = std::max(static_cast<int>(low.x()), 0); x < x_end; ++x) {
            const Vector2d apart = Vector2d(x, y) - drop.centre_px;
            const double off = apart.norm() / drop.radius_px;
            if (off >= 1) continue;
            const double cover = std::min((1 - off) / kSoft, 1.0);
            const double light = 1 - kRim * off * off;
            const Vector3d seen = behind.At(drop.centre_px - kSeen * apart);
            std::uint8_t& luma = nv12[static_cast<std::size_t>(y * width_px_ + x)];
            luma = Mixed(luma, light * seen[0], cover);
            if (y % 2 != 0 || x % 2 != 0) continue;
            std::uint8_t* uv = chroma + y / 2 * width_px_ + x;
            uv[0] = Mixed(uv[0], seen[1], cover);
            uv[1] = Mixed(uv[1], seen[2], cover);
        }
    }
}

}  // namespace hitchview::drivers
