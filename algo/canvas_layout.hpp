#pragma once

#include <Eigen/Core>
#include <optional>

#include "algo/projection.hpp"
#include "algo/unified_options.hpp"

namespace hitchview::algo {

/// Where the two views stand on the canvas before anything moves.
struct CanvasLayout {
    Eigen::Matrix3d M_canvas_tractor = Eigen::Matrix3d::Identity();
    /// Of the trailer's view while it is not placed by matching.
    Eigen::Matrix3d M_canvas_trailer = Eigen::Matrix3d::Identity();
};

/// A ring lies in the tractor's frame. On a plane, views that were matched are centred with their
/// joint bounding box; views that were not lie flush left and flush right; `options.placement`
/// overrides both. `options.border` kCovered zooms in by 1 / cropping or more, until views side by
/// side fill the canvas wherever their margins let them move; a trailer that swings may still leave
/// its outer edge in the picture.
/// `M_tractor_trailer`: the trailer's view on the tractor's, null while it is not known.
CanvasLayout LayOutCanvas(const Projection& canvas, const Projection& tractor,
                          const std::optional<Projection>& trailer,
                          const Eigen::Matrix3d* M_tractor_trailer,
                          const UnifiedVertexMotionOptions& options);

}  // namespace hitchview::algo
