#pragma once

#include <Eigen/Geometry>
#include <cstdint>
#include <optional>
#include <span>
#include <vector>

#include "algo/camera_model.hpp"

namespace hitchview::drivers {

/// A flat sheet of paper with something printed on it. Sheet frame: x along its width, y down it, z
/// away from who looks at it.
struct SheetOptions {
    struct Rectangle {
        Eigen::Vector2d from_m = Eigen::Vector2d::Zero();  ///< top left
        Eigen::Vector2d to_m = Eigen::Vector2d::Zero();    ///< bottom right
    };
    Rectangle paper{};
    std::vector<Rectangle> dark{};  ///< what is printed
};

/// A sheet that somebody holds before each camera, one place after another: all over the picture,
/// near and far, tilted to all sides, for some frames at each. Hides what is behind it.
/// Thread-safe.
class HeldSheet {
 public:
    /// Frames for which it stays at a place.
    static constexpr int kHeldFrames = 3;

    HeldSheet(const SheetOptions& options, const algo::CameraModel& lens, std::uint32_t seed);

    /// T_camera_sheet at a frame.
    [[nodiscard]] Eigen::Isometry3d PoseAt(int camera_index, int frame) const;
    /// Draws over an image of tightly packed NV12.
    void DrawOver(int camera_index, int frame, double gain, std::span<std::uint8_t> nv12) const;

 private:
    /// What a pixel shows of the sheet.
    struct Pixel {
        double share = 0;  ///< of the pixel that the sheet covers
        double white = 0;  ///< of that, the share of paper without print
    };

    void Print(const SheetOptions::Rectangle& dark);
    [[nodiscard]] std::optional<double> WhiteAt(const Eigen::Vector2d& at_m) const;
    [[nodiscard]] Pixel Look(const Eigen::Isometry3d& T_camera_sheet, int x_px, int y_px) const;

    SheetOptions options_;
    algo::CameraModel lens_;
    std::uint32_t seed_;
    double texels_per_m_ = 0;
    int texel_columns_ = 0, texel_rows_ = 0;
    std::vector<float> white_;           ///< share of paper in each texel, row by row
    std::vector<Eigen::Vector3d> rays_;  ///< of the corners of the pixels; zero: none
};

}  // namespace hitchview::drivers
