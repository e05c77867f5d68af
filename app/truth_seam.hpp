#pragma once

#include "algo/composition.hpp"

namespace hitchview::app {

/// What the seam states of one overlap were worth over time. Frames are observed in order.
class TruthSeam {
 public:
    /// `there`: the units' views overlap by geometry.
    void Observe(bool there, algo::SeamState state);

    struct Figures {
        int frames_there = 0;
        int frames_locked = 0;       ///< of those there
        int frames_locked_away = 0;  ///< said to be locked while there was no overlap
        int appearances = 0;         ///< times the overlap was there again, the start among them
        int longest_wait = 0;        ///< frames from there to locked or to its end
    };
    [[nodiscard]] Figures figures() const { return figures_; }

 private:
    Figures figures_;
    bool was_there_ = false;
    bool waiting_ = false;
    int wait_ = 0;
};

/// Largest change of a vertex of the stitching field from one frame to the next, in the half of
/// the ring where the overlap lies, while it is locked in both. Frames are observed in order.
class FieldJump {
 public:
    void Observe(algo::Overlap overlap, const algo::Composition& composition);
    [[nodiscard]] double largest_px() const { return largest_px_; }

 private:
    algo::VertexField early_ = algo::VertexField::Zero();
    bool early_locked_ = false;
    double largest_px_ = 0;
};

}  // namespace hitchview::app
