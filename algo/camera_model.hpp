#pragma once

#include <Eigen/Core>
#include <Eigen/Geometry>
#include <array>
#include <optional>
#include <string_view>

namespace hitchview::algo {

/// Lens of one camera. Camera frame: x right, y down, z along the optical axis. Pixel (0, 0) is the
/// centre of the top-left pixel.
///
/// kPinholeRadtan (OpenCV's `calib3d` model; k1 k2 p1 p2 k3), with a = x/z, b = y/z, r2 = a^2 +
/// b^2:
///     d  = 1 + k1 r2 + k2 r2^2 + k3 r2^3
///     a' = a d + 2 p1 a b + p2 (r2 + 2 a^2),  b' = b d + p1 (r2 + 2 b^2) + 2 p2 a b
/// kKannalaBrandt4 (OpenCV's `fisheye` model; k1 k2 k3 k4), theta = angle from the optical axis:
///     theta' = theta (1 + k1 theta^2 + k2 theta^4 + k3 theta^6 + k4 theta^8)
///     (a', b') = theta' (x, y) / |(x, y)|
/// Both: u = fx a' + cx,  v = fy b' + cy.
struct CameraModel {
    enum class Kind { kPinholeRadtan, kKannalaBrandt4 };

    Kind kind = Kind::kKannalaBrandt4;
    int width_px = 0;
    int height_px = 0;
    double fx_px = 0, fy_px = 0, cx_px = 0, cy_px = 0;
    std::array<double, 5> distortion{};  ///< four used by kKannalaBrandt4
    /// Rays further than this from the optical axis have no pixel. (0, pi/2) for a pinhole,
    /// (0, pi) for a fisheye lens; the distortion polynomial must grow up to here.
    double max_theta_rad = 1.4;

    /// Pixel that sees the direction `p_camera` (any length > 0); empty outside `max_theta_rad`.
    /// The pixel may lie outside the image. Thread-safe.
    [[nodiscard]] std::optional<Eigen::Vector2d> Project(const Eigen::Vector3d& p_camera) const;

    /// Unit-length direction that pixel (u, v) sees. Inverts Project by Newton's method to 1e-9
    /// rad; empty where the polynomial has no inverse within `max_theta_rad`. Thread-safe.
    [[nodiscard]] std::optional<Eigen::Vector3d> Unproject(const Eigen::Vector2d& pixel) const;
};

/// As it stands in calibration files.
std::string_view ToString(CameraModel::Kind kind);

/// A camera fixed to its unit. Unit frame: origin in the hitch point, x forward, y left, z up,
/// metres.
struct CameraGeometry {
    CameraModel model;
    Eigen::Isometry3d T_unit_camera = Eigen::Isometry3d::Identity();
};

}  // namespace hitchview::algo
