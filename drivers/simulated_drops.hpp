#pragma once

#include <Eigen/Core>
#include <cstdint>
#include <span>
#include <vector>

namespace hitchview::drivers {

/// Drops of rain on the glass before a lens. They are of the camera: what they hide moves with it.
/// Each is a small lens too near to be sharp: it shows a good part of the scene upside down and
/// blurred, with soft edges and a darker rim. Most stay, some run down. Thread-safe.
class LensDrops {
 public:
    /// `drops`: on each lens, for pictures of this size.
    LensDrops(int drops, int width_px, int height_px, std::uint32_t seed);

    /// Draws over an image of tightly packed NV12.
    void DrawOver(int camera_index, double time_s, std::span<std::uint8_t> nv12) const;

 private:
    struct Drop {
        Eigen::Vector2d centre_px;
        double radius_px;
    };
    /// The picture behind the drops, reduced.
    struct Blurred;

    [[nodiscard]] std::vector<Drop> DropsAt(int camera_index, double time_s) const;
    [[nodiscard]] Blurred Reduce(std::span<const std::uint8_t> nv12) const;
    void Draw(const Drop& drop, const Blurred& behind, std::span<std::uint8_t> nv12) const;

    int drops_;
    int width_px_;
    int height_px_;
    std::uint32_t seed_;
};

}  // namespace hitchview::drivers
