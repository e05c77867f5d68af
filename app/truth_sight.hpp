#pragma once

#include <Eigen/Core>
#include <array>
#include <optional>

#include "algo/composition.hpp"
#include "app/rig_geometry.hpp"
#include "drivers/simulated_rig.hpp"

namespace hitchview::app {

/// Where one unit shows a scene point.
struct Sighting {
    int camera = -1;   ///< of the unit; -1: not shown
    double share = 0;  ///< of this camera in the unit's view there
    Eigen::Vector2d view_px = Eigen::Vector2d::Zero();
    Eigen::Vector2d canvas_px = Eigen::Vector2d::Zero();
};

/// Finds scene points of the simulated rig in the units' views and on the canvas. Borrows both.
/// Thread: one; keeps what the cameras have around them in the frame asked for last.
class TruthSight {
 public:
    using Occlusion = drivers::SimulatedRig::Occlusion;

    TruthSight(const drivers::SimulatedRig& rig, const RigGeometry& geometry)
        : rig_(rig), geometry_(geometry) {}

    /// Through the camera of the unit that has the largest share in the view there; with
    /// Occlusion::kTested not shown if that camera has something in front of the point.
    [[nodiscard]] Sighting Find(algo::Unit unit, int frame, const Eigen::Vector3d& p_world_m,
                                Occlusion occlusion, const algo::Composition& composition);
    /// What the pixel of the unit's camera shows.
    [[nodiscard]] std::optional<drivers::SimulatedRig::SeenPoint> WorldPointAt(
        algo::Unit unit, int camera, int frame, const Eigen::Vector2d& pixel);
    /// Through this camera, however small its share; nothing is taken to be in front.
    [[nodiscard]] Sighting Through(algo::Unit unit, int camera, int frame,
                                   const Eigen::Vector3d& p_world_m,
                                   const algo::Composition& composition) const;

    /// Something stands in front of the point, for this camera.
    [[nodiscard]] bool IsHidden(algo::Unit unit, int camera, int frame,
                                const Eigen::Vector3d& p_world_m);

    /// Index in the simulated rig of the unit's camera `camera`.
    [[nodiscard]] int RigCamera(algo::Unit unit, int camera) const;
    [[nodiscard]] const drivers::SimulatedRig& rig() const { return rig_; }
    [[nodiscard]] const RigGeometry& geometry() const { return geometry_; }

 private:
    [[nodiscard]] Sighting Locate(algo::Unit unit, int camera, int frame,
                                  const Eigen::Vector3d& p_world_m) const;
    const drivers::Outlook& OutlookOf(int rig_camera, int frame);
    void Place(algo::Unit unit, const algo::Composition& composition, Sighting& sighting) const;

    const drivers::SimulatedRig& rig_;
    const RigGeometry& geometry_;
    int outlook_frame_ = -1;
    std::array<std::optional<drivers::Outlook>, drivers::SimulatedRig::kCameras> outlooks_;
};

}  // namespace hitchview::app
