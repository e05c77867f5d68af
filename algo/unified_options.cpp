#include "algo/unified_options.hpp"

#include <algorithm>
#include <numbers>

namespace hitchview::algo {
namespace {

constexpr double kDegree = std::numbers::pi / 180;

/// A narrow overlap needs pixels: a patch that is described is 36 px wide.
double AnalysisScale(const Projection& view, double overlap_rad) {
    if (!view.IsRing()) return view.width_px > 720 ? 0.5 : 1.0;
    const double wanted_px = overlap_rad < 20 * kDegree ? 2048 : 1024;
    return std::min(1.0, wanted_px / view.width_px);
}

/// What is given in px is for a ring with corners 8 px apart: px of this canvas to one of those.
double Fineness(const Projection& canvas) {
    return CornerSpacing_px(canvas) / 8.0;
}

/// Nothing is uncovered by a ring's heading or by a free border: the bound is how far the picture
/// may lag a bend or leave its place. What pulls back grows long before it.
void BoundFreely(const Projection& canvas, const Projection& view, PathSmootherOptions& smoother) {
    if (view.IsRing()) {  // steering is slow and a vehicle's shake fast: no need to hold back long
        smoother.wall = {10 * kDegree * view.focal_px, 6 * kDegree, 6 * kDegree};
        smoother.velocity_smoothing = 0.1;
        smoother.weakest_pull = 3e-4;
        smoother.strongest_pull = 1e-2;
        return;
    }
    const auto room = [](int canvas_px, int view_px) {  // that the canvas leaves beside the view
        return 0.376 * view_px + 0.5 * std::max(0, canvas_px - view_px);
    };
    smoother.wall = {room(canvas.width_px, view.width_px), room(canvas.height_px, view.height_px),
                     0.18};
}

/// The margin that the zoom leaves is a hard bound, shared by shift and turn; plans keep clear of
/// it. With few frames seen, what comes is unknown: then the path is followed more closely.
void BoundByMargin(const Projection& view, double cropping, PathSmootherOptions& smoother) {
    const double margin = 0.5 * (1 - cropping);
    const bool sees_ahead = smoother.lookahead_frames >= 3;
    smoother.wall = {margin * view.width_px, margin * view.height_px,
                     (sees_ahead ? 0.25 : 0.12) * margin};
    smoother.turn_takes_px = {0.5 * view.height_px, 0.5 * view.width_px};
    smoother.wall_stiffness = sees_ahead ? 4 : 0.1;
    smoother.guessed_wall_share = sees_ahead ? 0.84 : 0.82;
    smoother.weakest_pull = smoother.strongest_pull = sees_ahead ? 3e-5 : 1.3e-3;
    smoother.guess_damping = sees_ahead ? 0.95 : 0.8;
    smoother.horizon_frames = 22;
}

}  // namespace

UnitAnalysisOptions AnalysisOptions(const Projection& view, double overlap_rad) {
    UnitAnalysisOptions options;
    options.scale = AnalysisScale(view, overlap_rad);
    options.field.robust.max_sigma_px = 1.0 / options.scale;
    options.field.max_residual_px = 3.0 / options.scale;
    options.field.propagation = {.radius_px = {0.16 * view.width_px, 0.25 * view.height_px},
                                 .min_votes = 4,
                                 .shrink_votes = 6};
    if (view.IsRing()) options.field.propagation.radius_px.x() = 0.06 * view.width_px;
    options.field.turn.px_per_rad = view.focal_px;
    options.field.turn.first_spread_px = 4 / options.scale;
    options.field.turn.spread_px = 0.3 / options.scale;
    return options;
}

double MaxParallax_px(const Projection& canvas) {
    constexpr double kPlane_px = 24;
    constexpr double kRing_rad = 0.48;  // two metres between the cameras, 4 m to the thing
    return canvas.IsRing() ? kRing_rad * canvas.focal_px : kPlane_px;
}

double MaxMeshParallax_px(const Projection& canvas) {
    // On a ring the mesh follows the alignment surface; what stands before it would drag what is
    // behind it along, also far from the seams.
    constexpr double kRing_rad = 0.03;
    return canvas.IsRing() ? kRing_rad * canvas.focal_px : MaxParallax_px(canvas);
}

double MostDiscrepancy_px(const Projection& canvas) {
    return 2 * MaxMeshParallax_px(canvas);
}

double MostDetail_px(const Projection& canvas) {
    return MaxParallax_px(canvas) + MostDiscrepancy_px(canvas);
}

Eigen::Vector3d MostPlacement(const Projection& view) {
    constexpr double kUnbounded = 1e9;
    if (!view.IsRing()) return Eigen::Vector3d::Constant(kUnbounded);
    return {110 * kDegree * view.focal_px, 20 * kDegree, 20 * kDegree};
}

StitchingMotionFieldOptions StitchingOptions(const Projection& canvas, double kappa) {
    StitchingMotionFieldOptions options;
    options.kappa = kappa;
    options.most_px = MostDiscrepancy_px(canvas);
    options.fit.fade_px = 0.055 * canvas.width_px;
    if (canvas.IsRing()) {  // samples are dense, and the ground tilts with each unit
        options.max_stretch = kMaxStretch / std::max(kappa, 1 - kappa);
        options.fit.memory = 0.5;
        options.fit.change_px = 1.5 * Fineness(canvas);
        options.fit.outlier_px = 3 * Fineness(canvas);
    }
    return options;
}

SeamOptions SeamOptionsOf(const Projection& canvas) {
    SeamOptions options;
    if (canvas.IsRing()) {  // things pass by, and where the units agree nobody sees a seam move
        options.path.keep_cost = 1;
        options.path.least_win = 0.05F;
        options.path.least_gain = 0.3F;
        options.half_width_px *= Fineness(canvas);
        options.path.glide_px = static_cast<float>(16 * Fineness(canvas));
        options.path.dearest_way = 30;
    }
    return options;
}

DetailFieldOptions DetailOptions(const Projection& canvas, double kappa) {
    const double fineness = Fineness(canvas);
    DetailFieldOptions options{.kappa = kappa};
    for (double* px : {&options.reach_px, &options.outlier_px, &options.most_doubt_px,
                       &options.unknown_px, &options.past.sure_px, &options.past.unsure_px,
                       &options.past.most_step_px, &options.scanlines.lowest_px,
                       &options.scanlines.step_px, &options.scanlines.tolerance_px})
        *px *= fineness;
    return options;
}

SeamDetailOptions ShownDetailOptions(const Projection& canvas, double kappa) {
    SeamDetailOptions options{.kappa = kappa};
    options.core_px *= Fineness(canvas);
    options.fade_px *= Fineness(canvas);
    return options;
}

SeamCostOptions SeamCostOptionsOf(const Projection& canvas) {
    SeamCostOptions options;
    options.doubt_weight /= static_cast<float>(Fineness(canvas));
    return options;
}

double MostResidual_px(const Projection& view) {
    return 2 * Fineness(view);
}

OverlapDiscrepancyOptions DiscrepancyOptions(const Projection& canvas, double kappa) {
    OverlapDiscrepancyOptions options;
    options.kappa = kappa;
    options.propagation = {.radius_px = {0.05 * canvas.width_px, 0.2 * canvas.height_px},
                           .min_votes = 3,
                           .shrink_votes = 3};
    return options;
}

PathSmootherOptions StabilizerOptions(const Projection& canvas, const Projection& view,
                                      const UnifiedVertexMotionOptions& options) {
    PathSmootherOptions smoother;
    smoother.lookahead_frames = options.lookahead_frames;
    if (options.border == Border::kCovered && !view.IsRing()) {
        BoundByMargin(view, options.cropping, smoother);
    } else {
        BoundFreely(canvas, view, smoother);
    }
    return smoother;
}

UnitSmoother MakeUnitSmoother(const Projection& canvas, const Projection& view,
                              const UnifiedVertexMotionOptions& options) {
    const PathSmootherOptions smoother = StabilizerOptions(canvas, view, options);
    if (options.smoother == Smoother::kPaperWeights)
        return UnitSmoother(WalledPaperWeights(smoother));
    return UnitSmoother(PathSmoother(smoother));
}

PathSmootherOptions HitchSmootherOptions(const Projection& view) {
    PathSmootherOptions smoother;
    smoother.guess_damping = 0.85;
    smoother.velocity_smoothing = 0.15;
    smoother.weakest_pull = 0.03;
    smoother.strongest_pull = 3.0;
    smoother.wall = {8 * Fineness(view), view.IsRing() ? 0.02 : 8, view.IsRing() ? 0.02 : 0.03};
    return smoother;
}

TrailerPlacementOptions PlacementOptions(const Projection& canvas, double analysis_scale) {
    TrailerPlacementOptions options;
    // The intra motions carry what is fast; what matching adds per frame is noise and parallax.
    if (canvas.IsRing()) options.gain = 0.1;
    options.wall = MostPlacement(canvas);
    options.robust.max_sigma_px /= analysis_scale;
    options.acquire.max_sigma_px /= analysis_scale;
    return options;
}

}  // namespace hitchview::algo
