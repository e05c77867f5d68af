#pragma once

#include <Eigen/Core>
#include <optional>

#include "algo/articulation.hpp"
#include "algo/corner_grid.hpp"
#include "algo/mesh.hpp"
#include "algo/projection.hpp"
#include "algo/trailer_placement.hpp"
#include "algo/unit.hpp"

namespace hitchview::algo {

/// Where everything goes on the canvas at one moment: what the renderer needs.
struct Composition {
    PerUnit<Eigen::Matrix3d> M_canvas_view{
        {Eigen::Matrix3d::Identity(), Eigen::Matrix3d::Identity()}};
    /// On the view, before its pose: what is shown at view pixel y is read at y - view_offset(y).
    PerUnit<VertexField> view_offset{{VertexField::Zero(), VertexField::Zero()}};
    VertexField discrepancy = VertexField::Zero();  ///< see StitchingMotionField
    /// Ring: to be added to it where the two units meet, and how far off that may be; px. See
    /// DetailField. Without corners otherwise.
    CornerField detail;
    CornerScalars doubt_px;
    double kappa = 0.5;

    PerOverlap<SeamState> seams{{SeamState::kNoOverlap, SeamState::kNoOverlap}};
    PerOverlap<int> matches;
    PerUnit<int> features;
    PerUnit<PoseOffset> stabilization;  ///< S of each unit, for reports
    /// Ring only; for reports. Empty while it is not known.
    std::optional<Articulation> articulation;
};

/// The discrepancy with its detail at a canvas pixel.
Eigen::Vector2d WholeDiscrepancy(const Mesh& mesh, const Composition& composition,
                                 const Eigen::Vector2d& canvas_px);

/// Where the composition shows a ray of `unit`'s view, canvas px. Inverts what the composed map
/// does where the detail counts fully, to 0.1 px for fields that do not fold.
Eigen::Vector2d ToCanvas(const Projection& canvas, const Projection& view,
                         const Composition& composition, Unit unit,
                         const Eigen::Vector3d& view_ray);

}  // namespace hitchview::algo
