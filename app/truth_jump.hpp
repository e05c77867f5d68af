#pragma once

#include <Eigen/Core>
#include <optional>
#include <vector>

#include "algo/composed_map.hpp"
#include "app/truth_sight.hpp"

namespace hitchview::app {

/// What changes where the two units meet from one frame to the next beside what the true motion of
/// vehicle and scene changes, while a seam is locked in both frames. Frames are observed in order.
class TruthJump {
 public:
    TruthJump(const drivers::SimulatedRig& rig, const RigGeometry& geometry)
        : rig_(rig), sight_(rig, geometry) {}

    /// `used`: the composition as `map` shows it.
    void Observe(int frame, const algo::Composition& used, const algo::ComposedMap& map);

    struct Figures {
        /// Of the seam's misalignment: the median, over the scene points that lie on it in both
        /// frames, of how much farther each is shown apart by the units than one frame before; px.
        /// Where the true parallax of the two cameras changed, too, as of a thing close by that is
        /// passed, any share of that is no jump.
        double largest_seam_px = 0;
        /// The same of the placement alone, for what is far away; px.
        double largest_placement_px = 0;
        int frames = 0;  ///< that were compared
        /// Of every frame in which the seam was locked.
        std::vector<double> placement_errors_px;
    };
    [[nodiscard]] const Figures& figures(algo::Overlap overlap) const { return figures_[overlap]; }

 private:
    /// Of the misalignment of a scene point, px.
    using Change = Eigen::Vector2d;

    void ObserveSeam(algo::Overlap overlap, int frame, const algo::Composition& used,
                     const algo::ComposedMap& map);
    [[nodiscard]] std::optional<Change> ChangeAt(algo::Overlap overlap, int frame,
                                                 const algo::Composition& used,
                                                 const algo::ComposedMap& map, int row);
    [[nodiscard]] Eigen::Vector2d Parallax(const algo::PerUnit<int>& cameras, int frame,
                                           const Eigen::Vector3d& p_world_m,
                                           const algo::Composition& composition) const;
    [[nodiscard]] bool WasOnSeam(algo::Overlap overlap, const algo::ComposedMap& map,
                                 const Eigen::Vector2d& canvas_px) const;
    /// Of what is far away, on the horizon.
    [[nodiscard]] Eigen::Vector2d PlacementError(int frame, const algo::Composition& composition,
                                                 double seam_px) const;
    [[nodiscard]] Eigen::Vector3d OneFrameBefore(int frame, const Eigen::Vector3d& p_world_m) const;

    const drivers::SimulatedRig& rig_;
    TruthSight sight_;
    int early_frame_ = -1;
    algo::Composition early_;
    algo::PerOverlap<std::vector<double>> early_seam_px_;  // by row of corners
    algo::PerOverlap<Figures> figures_;
};

}  // namespace hitchview::app
