#pragma once

#include "algo/stitching_motion_field.hpp"

namespace hitchview::algo {

/// Discrepancy of one frame alone, at the vertices of the canvas; see StitchingMotionField for its
/// meaning.
struct MeasuredDiscrepancy {
    VertexField field = VertexField::Zero();
    VertexScalars confidence = VertexScalars::Zero();  ///< 0..1; 0: no pairs near the vertex
};

/// Spreads the pairs' discrepancies to the vertices around the points where both views meet. A
/// vertex counts only where its neighbours were heard too, because the field is a median over them.
MeasuredDiscrepancy MeasureDiscrepancy(const Projection& canvas, const CanvasPairs& pairs,
                                       double kappa, const PropagationOptions& propagation);

}  // namespace hitchview::algo
