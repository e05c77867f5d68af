#pragma once

#include "algo/corner_grid.hpp"
#include "algo/task_runner.hpp"
#include "algo/unit_seams.hpp"

namespace hitchview::algo {

struct SeamDetailOptions {
    double kappa = 0.5;
    double core_px = 12;   ///< on either side of a seam the detail counts fully
    double fade_px = 24;   ///< from there until it counts no more
    double stretch = 0.7;  ///< most that a unit's part may be stretched in a row, px per px
    double tilt = 0.05;    ///< likewise, rows against rows along a row
};

/// Near its seam the panorama is to fit; elsewhere only one unit shows, and things should keep
/// their shape. So the detail of the discrepancy fades out on both sides of each seam. Beginning at
/// the seam, the whole discrepancy (mesh and detail) changes from corner to corner by so little
/// that no unit's part of a row folds. Ring only.
/// `coarse`: what the mesh says of the discrepancy.
void FadeFromSeams(const CornerField& coarse, const CornerField& detail, const UnitSeams& seams,
                   const SeamDetailOptions& options, TaskRunner& runner, CornerField& shown);

}  // namespace hitchview::algo
