#pragma once

#include "algo/field_fit.hpp"
#include "algo/fixed_vector.hpp"
#include "algo/fold_guard.hpp"

namespace hitchview::algo {

/// One scene point as both units show it on the canvas, after stabilisation and placement.
struct CanvasPair {
    Eigen::Vector2d tractor_px;
    Eigen::Vector2d trailer_px;
};
inline constexpr std::size_t kMaxCanvasPairs = 2048;
using CanvasPairs = FixedVector<CanvasPair, kMaxCanvasPairs>;

/// e of one pair, at the point where both views meet; see StitchingMotionField.
inline PointMotion DiscrepancyOf(const CanvasPair& pair, const Projection& canvas, double kappa) {
    const Eigen::Vector2d e_px = canvas.Difference(pair.trailer_px, pair.tractor_px);
    return {pair.tractor_px + kappa * e_px, e_px};
}

struct StitchingMotionFieldOptions {
    double kappa = 0.5;  ///< who moves: 0 the trailer alone, 1 the tractor alone
    FieldFitOptions fit{};
    double forgetting = 0.8;           ///< share of a vertex's confidence that stays, per frame
    double max_stretch = kMaxStretch;  ///< of the fold guard
    double most_px = 48;               ///< bound of the field, per axis
};

/// Stitching motion field (paper, same section), with the discrepancy e = trailer - tractor that is
/// left on the canvas after the rigid placement. Live form: one robust fit to the pairs of all
/// overlaps and to the field of the frame before, carried along with the scene (docs/algorithm.md,
/// section 8). Defined at the vertices of the canvas, at the point where both views meet: tractor
/// pixels are read at c - kappa e(c), trailer pixels at c + (1 - kappa) e(c).
class StitchingMotionField {
 public:
    StitchingMotionField(const Projection& canvas, const StitchingMotionFieldOptions& options);

    /// Lets the field move with what it is a property of: `M_early_late` takes rays of the canvas
    /// to where the same things lay one frame ago. Call before Update.
    void Carry(const Eigen::Matrix3d& M_early_late);
    /// Takes the newest pairs of one overlap. Call once per overlap, then Extend.
    void Update(const CanvasPairs& pairs);
    /// Fits the field to what was taken and guards against folds.
    void Extend();
    void Reset();

    [[nodiscard]] const VertexField& discrepancy() const { return field_; }
    [[nodiscard]] const Mesh& mesh() const { return mesh_; }
    /// Displacement of the place where `unit`'s pixels for the canvas pixel are read.
    [[nodiscard]] Eigen::Vector2d TractorDisplacement(const Eigen::Vector2d& canvas_px) const {
        return -options_.kappa * Sample(mesh_, field_, canvas_px);
    }
    [[nodiscard]] Eigen::Vector2d TrailerDisplacement(const Eigen::Vector2d& canvas_px) const {
        return (1 - options_.kappa) * Sample(mesh_, field_, canvas_px);
    }

 private:
    Projection canvas_;
    Mesh mesh_;
    StitchingMotionFieldOptions options_;
    FieldFit fit_;
    FixedVector<PointMotion, 2 * kMaxCanvasPairs> samples_;
    VertexField predicted_ = VertexField::Zero();
    VertexScalars confidence_ = VertexScalars::Zero();  // 0..1, of the field before
    VertexScalars support_ = VertexScalars::Zero();
    VertexField field_ = VertexField::Zero();
};

}  // namespace hitchview::algo
