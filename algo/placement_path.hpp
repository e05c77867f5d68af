#pragma once

#include <Eigen/Core>
#include <vector>

#include "algo/projection.hpp"

namespace hitchview::algo {

/// The placement of one frame, and how far it is to be believed.
struct PlacementSample {
    Eigen::Matrix3d pose = Eigen::Matrix3d::Identity();  ///< similarity, or rotation on a ring
    double confidence = 0;                               ///< 0..1; 0: `pose` means nothing
};

/// Placements of a whole recording, smoothed in time by confidence (see SmoothByConfidence): shift,
/// turn and, on a plane, scale. Frames without a placement are bridged. Empty if no frame has one.
/// `view`: the picture that the poses lead to.
std::vector<Eigen::Matrix3d> SmoothPlacements(const Projection& view,
                                              const std::vector<PlacementSample>& samples,
                                              double mu, int radius_frames);

}  // namespace hitchview::algo
