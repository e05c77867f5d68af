#pragma once

#include <Eigen/Core>
#include <Eigen/Geometry>
#include <cmath>

namespace hitchview::algo {

/// How a picture (the canvas, or one unit's view) relates to rays. A pose of a picture is then one
/// 3x3 matrix on rays, whatever the projection:
///   kPlane     ray = (x, y, 1): a similarity (or homography) of the plane, pixels.
///   kCylinder  ray = (cos a, sin a, tan e) in a unit frame (x forward, y left, z up): a rotation.
/// Cylinder: azimuth a is positive to the left and falls with x; elevation e is positive upwards;
///     x = centre_x - f (a - a0),  y = horizon_y - f tan e,  f = width / 2 pi.
struct Projection {
    enum class Kind { kPlane, kCylinder };

    Kind kind = Kind::kPlane;
    int width_px = 0;
    int height_px = 0;
    double focal_px = 1;            ///< cylinder: pixels per radian
    double horizon_y_px = 0;        ///< cylinder: row of elevation 0
    double azimuth_centre_rad = 0;  ///< cylinder: azimuth of the middle column

    static Projection Plane(int width_px, int height_px);
    /// The whole ring. `horizon`: share of the height above elevation 0.
    static Projection Cylinder(int width_px, int height_px, double horizon,
                               double azimuth_centre_rad = 0);

    /// The same picture at `scale` of its size.
    [[nodiscard]] Projection Scaled(double scale) const;

    [[nodiscard]] bool IsRing() const { return kind == Kind::kCylinder; }
    [[nodiscard]] Eigen::Vector2d Centre() const {
        return {0.5 * (width_px - 1), IsRing() ? horizon_y_px : 0.5 * (height_px - 1)};
    }

    /// Ray of a pixel; not normalised.
    [[nodiscard]] Eigen::Vector3d Ray(const Eigen::Vector2d& pixel) const;
    /// Pixel of a ray of any length; on a ring x is in [-0.5, width - 0.5).
    [[nodiscard]] Eigen::Vector2d Pixel(const Eigen::Vector3d& ray) const;
    /// Shortest difference a - b: on a ring it may cross the edge.
    [[nodiscard]] Eigen::Vector2d Difference(const Eigen::Vector2d& a,
                                             const Eigen::Vector2d& b) const;
};

inline Eigen::Vector2d Projection::Difference(const Eigen::Vector2d& a,
                                              const Eigen::Vector2d& b) const {
    Eigen::Vector2d d = a - b;
    if (IsRing() && std::abs(d.x()) > 0.5 * width_px)
        d.x() -= width_px * std::round(d.x() / width_px);
    return d;
}

/// x modulo `width`, in [-0.5, width - 0.5).
inline double WrapColumn(double x, double width) {
    if (x >= -0.5 && x < width - 0.5) return x;  // as most are
    return x - width * std::floor((x + 0.5) / width);
}

/// A pose of a picture as three numbers that smoothing can work on.
///   kPlane     shift of the picture's centre (x, y) in px, turn clockwise on the screen in rad
///   kCylinder  heading as a shift in x (px at the horizon), then the turns about the forward and
///              the left axis (rad)
struct PoseOffset {
    Eigen::Vector3d value = Eigen::Vector3d::Zero();
};

/// The rigid part of `pose` (a similarity loses its scale), and back.
PoseOffset ToOffset(const Projection& projection, const Eigen::Matrix3d& pose);
Eigen::Matrix3d ToPose(const Projection& projection, const PoseOffset& offset);

/// Plane pose that zooms by `zoom` and leaves `centre` where it is.
Eigen::Matrix3d ZoomAbout(const Eigen::Vector2d& centre, double zoom);

/// Scale of a plane pose at the picture's centre; 1 on a ring.
double ScaleOf(const Projection& projection, const Eigen::Matrix3d& pose);

}  // namespace hitchview::algo
