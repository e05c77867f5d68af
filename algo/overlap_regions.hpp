#pragma once

#include <Eigen/Core>
#include <opencv2/core/types.hpp>

#include "algo/projection.hpp"
#include "algo/semi_surround_view.hpp"
#include "algo/unit.hpp"

namespace hitchview::algo {

/// One unit's view of a ring and its picture for analysis.
struct AnalysedRing {
    const SemiSurroundView* analysis;
    Projection view;
};

/// How much of the horizon both units of a ring see on one side while the trailer follows straight.
double OverlapWidth_rad(const PerUnit<UnitGeometry>& geometry, Overlap overlap);

/// The half of each analysis view of a ring that lies on the side of `overlap`: left of the
/// vehicle lies left of the middle in the tractor's, and right of it in the trailer's, which looks
/// back.
PerUnit<cv::Rect> SideRegions(const PerUnit<AnalysedRing>& rings, Overlap overlap);

/// The columns of those halves in which each unit sees what the other one sees, too, as far as
/// `R_tractor_trailer` (trailer's rays to the tractor's) is right to `tolerance_rad`; of the full
/// height. Empty where nothing overlaps.
PerUnit<cv::Rect> OverlapRegions(const PerUnit<AnalysedRing>& rings,
                                 const Eigen::Matrix3d& R_tractor_trailer, Overlap overlap,
                                 double tolerance_rad);

}  // namespace hitchview::algo
