#pragma once

#include "algo/magsac.hpp"
#include "algo/stitching_motion_field.hpp"

namespace hitchview::algo {

struct OverlapDiscrepancyOptions {
    double kappa = 0.5;           ///< who moves: 0 the trailer alone, 1 the tractor alone
    int homography_inliers = 24;  ///< fewer pairs carry no global model
    MagsacOptions robust{.max_sigma_px = 1.5, .max_iterations = 150};
    PropagationOptions propagation{};
};

/// Discrepancy of one frame alone, at the vertices of the canvas; see StitchingMotionField for its
/// meaning.
struct MeasuredDiscrepancy {
    VertexField field = VertexField::Zero();
    VertexScalars confidence = VertexScalars::Zero();  ///< 0..1; 0: no pairs near the vertex
};

/// Measures the discrepancy of single frames: the dominant plane of an overlap by a homography,
/// what does not lie on it by the votes of the pairs around a vertex.
class OverlapDiscrepancy {
 public:
    OverlapDiscrepancy(const Projection& canvas, const OverlapDiscrepancyOptions& options);

    /// Adds the pairs of one overlap to `measured`; where it has a value already, the more
    /// confident one stays.
    void Measure(const CanvasPairs& pairs, MeasuredDiscrepancy& measured);

 private:
    /// Motion of the canvas from the tractor's to the trailer's position, about `origin_px`.
    struct Plane {
        Eigen::Matrix3d H = Eigen::Matrix3d::Identity();
        Eigen::Vector2d origin_px = Eigen::Vector2d::Zero();
        bool known = false;
    };

    [[nodiscard]] Plane FitPlane(const CanvasPairs& pairs);
    [[nodiscard]] Eigen::Vector2d GapOn(const Plane& plane, const Eigen::Vector2d& at_px) const;
    [[nodiscard]] bool AllNeighboursHeard(const VertexScalars& votes, int row, int col) const;

    Projection canvas_;
    Mesh mesh_;
    OverlapDiscrepancyOptions options_;
    MagsacEstimator<HomographyModel, kMaxCanvasPairs> homography_;
};

}  // namespace hitchview::algo
