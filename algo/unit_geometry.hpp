#pragma once

#include <Eigen/Core>
#include <bitset>
#include <optional>
#include <span>

#include "algo/camera_model.hpp"
#include "algo/fixed_vector.hpp"
#include "algo/projection.hpp"

namespace hitchview::algo {

inline constexpr std::size_t kMaxCameras = 8;

/// Some of a unit's cameras; bit i is camera i.
using CameraMask = std::bitset<kMaxCameras>;

/// The surface on which the cameras of a ring are aligned: what lies on it shows no parallax.
/// A vertical cylinder round the hitch axis, cut off below by the ground.
struct AlignmentSurface {
    double radius_m = 1000;    ///< of the cylinder
    double viewpoint_m = 1.3;  ///< height of the panorama's viewpoint above the hitch point
    double ground_m = -0.4;    ///< height of the ground in the unit frame, below the viewpoint

    /// Point of the surface, in the unit frame, that `ray` of the view hits.
    [[nodiscard]] Eigen::Vector3d Hit(const Eigen::Vector3d& ray) const;
    /// Ray of the view that hits the surface where `direction` from `position_m` does (a place
    /// inside).
    [[nodiscard]] Eigen::Vector3d RayOf(const Eigen::Vector3d& position_m,
                                        const Eigen::Vector3d& direction) const;
};

/// Where one camera sees a ray of its unit's view.
struct CameraSight {
    int camera;             ///< index within the unit
    Eigen::Vector2d pixel;  ///< of the camera's picture; perhaps outside it
    double weight;          ///< share in the view, 0..1; the shares of a ray add up to 1
};

/// Distance of a pixel to the nearer side edge of a picture, as a share of its width; less than 0
/// outside.
double SideMargin(int width_px, int height_px, const Eigen::Vector2d& pixel);

/// Where a camera stands and in which direction it sees something; in the frame of its unit.
struct SightLine {
    Eigen::Vector3d origin_m;   ///< the camera's centre of projection
    Eigen::Vector3d direction;  ///< of unit length
};

/// How the cameras of one unit make up its semi-surround view.
/// Plane: one camera, whose picture is the view. Ring: calibrated cameras on a cylinder round the
/// hitch point. Neighbouring cameras are blended where both are about equally far from their edge.
class UnitGeometry {
 public:
    using Sights = FixedVector<CameraSight, kMaxCameras>;

    /// Cameras are blended where their margins (see SideMargin) differ by less.
    static constexpr double kBlendWidth = 0.035;

    static UnitGeometry Plane(int width_px, int height_px);
    /// 1..kMaxCameras cameras. `view`: a ring.
    static UnitGeometry Ring(const Projection& view, std::span<const CameraGeometry> cameras,
                             const AlignmentSurface& surface);

    [[nodiscard]] const Projection& view() const { return view_; }
    [[nodiscard]] int cameras() const { return camera_count_; }
    [[nodiscard]] int camera_width_px(int camera) const { return mounted(camera).model.width_px; }
    [[nodiscard]] int camera_height_px(int camera) const { return mounted(camera).model.height_px; }

    /// Cameras that have a pixel for `ray` of the view, also outside their picture: there their
    /// share is 0 on a ring. The one camera of a plane always has all of it.
    void See(const Eigen::Vector3d& ray, Sights& sights) const {
        See(ray, CameraMask().set(), sights);
    }
    /// The same where only some cameras give a picture: the others have no share.
    void See(const Eigen::Vector3d& ray, const CameraMask& present, Sights& sights) const;
    /// Makes shares of weights that are margins (see SideMargin).
    static void ShareByMargins(Sights& sights);

    /// Pixel of `camera` for a ray of the view, also outside the picture; false if it has none.
    [[nodiscard]] bool Project(int camera, const Eigen::Vector3d& ray,
                               Eigen::Vector2d& pixel) const;

    /// Ray of the view that a pixel of `camera` shows: inverts Project. Empty where the lens has
    /// none.
    [[nodiscard]] std::optional<Eigen::Vector3d> ViewRay(int camera,
                                                         const Eigen::Vector2d& pixel) const;

    /// Pixels of a ring's `camera` to one of the view where it shows the horizon, on average over
    /// the columns in which it has the largest share; 1 where there are none, and of a plane.
    [[nodiscard]] double PixelsAtHorizon(int camera) const;

    /// How the camera with the largest share in `ray` of a ring's view sees what is shown there.
    /// Empty where no camera has a share.
    [[nodiscard]] std::optional<SightLine> SightAlong(const Eigen::Vector3d& ray) const;
    /// How `camera` sees what is shown along `ray` of a ring's view.
    [[nodiscard]] SightLine SightOf(int camera, const Eigen::Vector3d& ray) const;
    /// How far the alignment surface is from a camera at `origin_m` where `ray` of a ring's view
    /// shows it.
    [[nodiscard]] double SurfaceDistance_m(const Eigen::Vector3d& origin_m,
                                           const Eigen::Vector3d& ray) const {
        return (surface_.Hit(ray) - origin_m).norm();
    }
    /// Row of a ring's view where ground and cylinder of the alignment surface meet.
    [[nodiscard]] double SurfaceEdge_px() const {
        return view_.horizon_y_px +
               view_.focal_px * (surface_.viewpoint_m - surface_.ground_m) / surface_.radius_m;
    }
    /// Ray of a ring's view in which a camera at `origin_m` shows what lies in `direction`.
    [[nodiscard]] Eigen::Vector3d RayToward(const Eigen::Vector3d& origin_m,
                                            const Eigen::Vector3d& direction) const {
        return surface_.RayOf(origin_m, direction);
    }

 private:
    struct MountedCamera {
        CameraModel model;
        Eigen::Matrix3d R_camera_unit;
        Eigen::Vector3d position_m;
        double least_cosine;  ///< of the angle from the optical axis that the lens can see
    };

    /// The camera with the largest share.
    [[nodiscard]] std::optional<int> MainCamera(const Eigen::Vector3d& ray) const;
    static bool ProjectPoint(const MountedCamera& camera, const Eigen::Vector3d& p_unit_m,
                             Eigen::Vector2d& pixel);
    [[nodiscard]] const MountedCamera& mounted(int camera) const {
        return cameras_[static_cast<std::size_t>(camera)];
    }

    Projection view_;
    AlignmentSurface surface_;
    int camera_count_ = 0;
    std::array<MountedCamera, kMaxCameras> cameras_{};
};

}  // namespace hitchview::algo
