#pragma once

#include <atomic>
#include <optional>
#include <vector>

#include "algo/composed_map.hpp"
#include "algo/composition.hpp"
#include "app/rig_geometry.hpp"
#include "hal/overlay.hpp"

namespace hitchview::app {

/// Tells where meshes and seams lie on a panorama. The pipeline leaves a copy of what that follows
/// from, some 40 kB; the publisher's thread works it out. Memory is taken at construction.
class OverlayMaker {
 public:
    /// `period`: between two overlays, at least. `block_px`: of the composed map.
    OverlayMaker(const RigGeometry& rig, int block_px, hal::Instant period);

    /// What an overlay is of.
    struct Shown {
        std::uint32_t sequence = 0;
        hal::Instant captured_from{};
    };
    /// Takes a copy if one is due and the one before was taken. Thread: pipeline.
    void Offer(const Shown& shown, const algo::Composition& composition,
               const algo::ComposedMap& map, hal::Instant now);
    /// The overlay of what was left last; empty when that was taken before. Borrowed until the next
    /// call. Thread: publisher.
    std::optional<hal::Overlay> Take();

 private:
    struct UnitMesh {
        algo::Projection view;
        std::vector<Eigen::Vector3d> rays;  ///< of the vertices
        std::vector<bool> seen;             ///< by a camera of the unit
    };
    void Copy(const algo::Composition& composition, const algo::ComposedMap& map);
    void Place(algo::Unit unit);

    algo::Projection canvas_;
    algo::PerUnit<std::optional<UnitMesh>> meshes_;
    hal::Instant period_;
    hal::Instant next_at_{};
    std::atomic<bool> left_{false};
    Shown shown_;
    algo::Composition composition_;
    std::vector<float> seam_y_;
    algo::PerOverlap<std::vector<float>> seam_x_;
    std::vector<float> mesh_x_;
    std::vector<float> mesh_y_;
    algo::PerOverlap<std::vector<float>> told_seam_x_;
};

}  // namespace hitchview::app
