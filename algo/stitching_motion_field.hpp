#pragma once

#include "algo/magsac.hpp"
#include "algo/mesh.hpp"
#include "algo/vertex_propagation.hpp"

namespace hitchview::algo {

/// One scene point as both units show it on the canvas, after stabilisation and placement.
struct CanvasPair {
    Eigen::Vector2d tractor_px;
    Eigen::Vector2d trailer_px;
};
inline constexpr std::size_t kMaxCanvasPairs = 768;
using CanvasPairs = FixedVector<CanvasPair, kMaxCanvasPairs>;

struct StitchingMotionFieldOptions {
    double kappa = 0.5;  ///< who moves: 0 the trailer alone, 1 the tractor alone
    double gain = 0.8;   ///< share of the newest measurement at a well supported vertex
    double max_discrepancy_px = 24;
    int homography_inliers = 24;  ///< fewer pairs carry no global model
    MagsacOptions robust{.max_sigma_px = 1.5, .max_iterations = 150};
    PropagationOptions propagation{};
    double fade_per_cell =
        0.35;                  ///< pull to zero outside the overlap, against the neighbours' pull
    int sweeps = 24;           ///< of the extension outside the overlap
    double max_stretch = 0.4;  ///< fold guard: largest change of the field per cell, in cells
};

/// Stitching motion field (paper, same section), with the discrepancy e = trailer - tractor that is
/// left on the canvas after the rigid placement: dominant plane by a homography, the rest as
/// residual motion inside the ellipse; smoothed in time by a gain (facts 4.6), continued
/// harmonically outside the overlap and faded to zero. Defined at the vertices of the canvas, at
/// the point where both views meet: tractor pixels are read at c - kappa e(c), trailer pixels at c
/// + (1 - kappa) e(c).
class StitchingMotionField {
 public:
    StitchingMotionField(const Projection& canvas, const StitchingMotionFieldOptions& options);

    /// Lets the field move with what it is a property of: `M_early_late` takes rays of the canvas
    /// to where the same things lay one frame ago. Call before Update.
    void Carry(const Eigen::Matrix3d& M_early_late);
    /// Takes the newest pairs of one overlap. Call once per overlap, then Extend.
    void Update(const CanvasPairs& pairs);
    /// Continues the field outside the supported vertices and guards against folds.
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
    [[nodiscard]] Eigen::Vector2d MeetingPoint(const CanvasPair& pair) const;
    [[nodiscard]] Eigen::Vector2d Discrepancy(const CanvasPair& pair) const;
    void FitDominantPlane(const CanvasPairs& pairs);
    [[nodiscard]] Eigen::Vector2d PlaneDiscrepancy(const Eigen::Vector2d& at_px) const;
    void SpreadResiduals(const CanvasPairs& pairs);
    void Blend(const CanvasPairs& pairs);
    void GuardFolds();

    Projection canvas_;
    Mesh mesh_;
    StitchingMotionFieldOptions options_;
    MagsacEstimator<HomographyModel, kMaxCanvasPairs> homography_;
    FixedVector<RayPair, kMaxCanvasPairs> pairs_;
    FixedVector<PointMotion, kMaxCanvasPairs> residuals_;

    bool plane_known_ = false;
    Eigen::Matrix3d H_plane_ = Eigen::Matrix3d::Identity();   // meeting point -> meeting point + e
    Eigen::Vector2d plane_origin_ = Eigen::Vector2d::Zero();  // unwraps the ring
    VertexField residual_field_ = VertexField::Zero();
    VertexScalars votes_ = VertexScalars::Zero();
    VertexScalars support_ = VertexScalars::Zero();  // 0..1, of this frame
    VertexField field_ = VertexField::Zero();
};

}  // namespace hitchview::algo
