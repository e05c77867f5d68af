#pragma once

#include <nlohmann/json_fwd.hpp>
#include <string>
#include <vector>

#include "algo/composition_bounds.hpp"
#include "app/pipeline.hpp"
#include "app/truth_coverage.hpp"
#include "app/truth_jump.hpp"

namespace hitchview::app {

/// Whether a drive keeps what the panorama promises for every frame, whatever the cameras see
/// (docs/algorithm.md, section 13). Thread: one; frames in order.
class SafetyMeter {
 public:
    SafetyMeter(const drivers::SimulatedRig& rig, const RigGeometry& geometry);

    /// `pictures`: those that the panorama was made of.
    void Observe(const ShownPanorama& shown, const algo::ComposedMap& map,
                 const algo::RigPictures& pictures);

    [[nodiscard]] nlohmann::json Figures() const;

 private:
    /// `there`: the units' views overlap by geometry.
    void ObserveSeam(algo::Overlap overlap, algo::SeamState state, bool there);
    void ObservePixels(const ShownPanorama& shown, const algo::ComposedMap& map,
                       const algo::RigPictures& pictures);

    /// As L120 C5 L175: locked, coast, no overlap, reacquire, each with its frames.
    [[nodiscard]] std::string StatesOf(algo::Overlap overlap) const;

    struct Stay {
        algo::SeamState state;
        int frames;
    };
    /// Of the panoramas that lack no camera, every so manieth is drawn anew.
    static constexpr int kPixelsEvery = 10;

    const RigGeometry& geometry_;
    algo::CompositionBounds bounds_;
    const drivers::SimulatedRig& rig_;
    TruthJump jump_;
    TruthCoverage coverage_;
    algo::OffsetShares largest_;
    long folded_cells_ = 0;
    long frames_locked_away_ = 0;
    long stale_bytes_ = 0;
    long pictures_ = 0;
    long frames_ = 0;
    double rate_hz_;
    algo::PerOverlap<std::vector<Stay>> stays_;
};

/// Cells of the map as it is drawn, each camera's apart, that are turned over or have no area
/// anywhere: those whose corners the camera has a pixel for inside its picture, or that are shown.
long FoldedDrawnCells(const algo::ComposedMap& map, const RigGeometry& geometry);

}  // namespace hitchview::app
