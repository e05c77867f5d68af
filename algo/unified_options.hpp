#pragma once

#include <Eigen/Core>
#include <optional>

#include "algo/detail_field.hpp"
#include "algo/overlap_discrepancy.hpp"
#include "algo/path_smoother.hpp"
#include "algo/seam_cost.hpp"
#include "algo/seam_detail.hpp"
#include "algo/stitching_motion_field.hpp"
#include "algo/trailer_placement.hpp"
#include "algo/unit_analysis.hpp"
#include "algo/unit_seams.hpp"
#include "algo/unit_smoother.hpp"

namespace hitchview::algo {

enum class Border { kFree, kCovered };
/// PathSmoother or the paper's weights, WalledPaperWeights.
enum class Smoother { kRecedingHorizon, kPaperWeights };

struct UnifiedVertexMotionOptions {
    bool stabilize = true;
    bool stitch = true;
    int lookahead_frames = 0;       ///< 0..kMaxLookahead
    Border border = Border::kFree;  ///< kFree: uncovered pixels are no data; kCovered: zoomed in
    double cropping = 0.90;         ///< kCovered: share of the view's width that stays visible
    Smoother smoother = Smoother::kRecedingHorizon;  ///< of each unit's own path
    double kappa = 0.5;  ///< who moves in an overlap: 0 the trailer, 1 the tractor
    /// Plane: top-left pixel of each unit on the canvas, instead of matching.
    PerUnit<std::optional<Eigen::Vector2d>> placement;
};

/// Pairs farther from the rigid placement than this are another thing, not parallax; canvas px.
double MaxParallax_px(const Projection& canvas);
/// Pairs farther from it than this are left to the detail of the seams; canvas px.
double MaxMeshParallax_px(const Projection& canvas);

/// Bound of the stitching field, per axis: twice the pairs that it is fitted to, as a plane through
/// pairs in one part of a cell goes on beyond them; canvas px.
double MostDiscrepancy_px(const Projection& canvas);
/// Bound of the detail at the seams, per axis: what it is fitted to, less the field; canvas px.
double MostDetail_px(const Projection& canvas);
/// Bound of where the trailer's view may lie on the tractor's, as a PoseOffset; plane: none.
/// Placement differs from articulation by up to 19 degrees (docs/algorithm.md, section 7).
Eigen::Vector3d MostPlacement(const Projection& view);

/// The stages' options for pictures of this kind and size: one place for what was tuned.
/// `overlap_rad`: ring only, how much of the horizon both units see where that is least.
UnitAnalysisOptions AnalysisOptions(const Projection& view, double overlap_rad);
StitchingMotionFieldOptions StitchingOptions(const Projection& canvas, double kappa);
SeamOptions SeamOptionsOf(const Projection& canvas);
SeamCostOptions SeamCostOptionsOf(const Projection& canvas);
DetailFieldOptions DetailOptions(const Projection& canvas, double kappa);
SeamDetailOptions ShownDetailOptions(const Projection& canvas, double kappa);
/// Bound of the per-vertex offset of a view, px.
double MostResidual_px(const Projection& view);
/// Of single frames of a recording.
OverlapDiscrepancyOptions DiscrepancyOptions(const Projection& canvas, double kappa);
TrailerPlacementOptions PlacementOptions(const Projection& canvas, double analysis_scale);
/// Of one unit's own path.
PathSmootherOptions StabilizerOptions(const Projection& canvas, const Projection& view,
                                      const UnifiedVertexMotionOptions& options);
UnitSmoother MakeUnitSmoother(const Projection& canvas, const Projection& view,
                              const UnifiedVertexMotionOptions& options);
/// Of the trailer's placement on the canvas.
PathSmootherOptions HitchSmootherOptions(const Projection& view);

}  // namespace hitchview::algo
