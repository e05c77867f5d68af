#pragma once

#include "algo/feature_matcher.hpp"
#include "algo/mesh.hpp"
#include "algo/semi_surround_view.hpp"

namespace hitchview::algo {

/// Expects what one unit's view shows where the views' poses on the canvas and the discrepancy
/// known so far put it in the other one's. Borrows all it is given.
class Guidance final : public Expectation {
 public:
    struct Side {
        const SemiSurroundView* analysis;
        Projection view;
        Eigen::Matrix3d M_canvas_view;
    };

    /// Counts in `candidates` what is expected inside the other view.
    Guidance(const Projection& canvas, const PerUnit<Side>& sides, const VertexField& discrepancy,
             Overlap overlap, int& candidates);

    bool Expect(Unit unit, const Eigen::Vector2f& pixel, Eigen::Vector2f& other) const override;

 private:
    [[nodiscard]] bool InOverlap(const Eigen::Vector2d& canvas_px) const;

    const Projection& canvas_;
    Mesh mesh_;
    const PerUnit<Side>& sides_;
    PerUnit<Eigen::Matrix3d> M_view_canvas_;
    const VertexField& discrepancy_;
    Overlap overlap_;
    int& candidates_;
};

}  // namespace hitchview::algo
