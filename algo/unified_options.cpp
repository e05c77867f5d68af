#include "algo/unified_options.hpp"

#include <algorithm>
#include <numbers>

namespace hitchview::algo {
namespace {

using Eigen::Vector3d;

double AnalysisScale(const Projection& view) {
    if (view.IsRing()) return std::min(1.0, 1024.0 / view.width_px);
    return view.width_px > 960 ? 0.5 : 1.0;
}

/// Bounds of a unit's offset: shift in px of the view, turn in rad.
Vector3d Wall(const Projection& view, const UnifiedVertexMotionOptions& options) {
    constexpr double kDegree = std::numbers::pi / 180;
    // A ring has no border sideways: there the bound is the lag of the heading in a bend.
    if (view.IsRing()) return {8 * kDegree * view.focal_px, 3 * kDegree, 3 * kDegree};
    if (options.border == Border::kFree) return {0.28 * view.width_px, 0.28 * view.height_px, 0.06};
    const double margin = 0.5 * (1 - options.cropping);
    // The turn eats its share of the shift's margin: half the diagonal times the turn.
    const double turn = 0.25 * margin;
    return {margin * view.width_px - 0.5 * turn * view.height_px,
            margin * view.height_px - 0.5 * turn * view.width_px, turn};
}

}  // namespace

UnitAnalysisOptions AnalysisOptions(const Projection& view) {
    UnitAnalysisOptions options;
    options.scale = AnalysisScale(view);
    options.field.robust.max_sigma_px = 1.0 / options.scale;
    options.field.max_residual_px = 3.0 / options.scale;
    options.field.propagation = {.radius_px = {0.16 * view.width_px, 0.25 * view.height_px},
                                 .min_votes = 4,
                                 .shrink_votes = 6};
    if (view.IsRing()) options.field.propagation.radius_px.x() = 0.06 * view.width_px;
    return options;
}

StitchingMotionFieldOptions StitchingOptions(const Projection& canvas, double kappa) {
    StitchingMotionFieldOptions options;
    options.kappa = kappa;
    options.propagation = {.radius_px = {0.05 * canvas.width_px, 0.2 * canvas.height_px},
                           .min_votes = 3,
                           .shrink_votes = 3};
    options.max_discrepancy_px = kMaxParallax_px;
    // Round a vehicle near and far things mix in an overlap, and single measurements jump.
    if (canvas.IsRing()) options.gain = 0.3;
    return options;
}

PathSmootherOptions StabilizerOptions(const Projection& view,
                                      const UnifiedVertexMotionOptions& options) {
    PathSmootherOptions smoother;
    smoother.lookahead_frames = options.lookahead_frames;
    smoother.wall = Wall(view, options);
    if (view.IsRing()) {  // steering is slow and a vehicle's shake fast: no need to hold back
                          // longer
        smoother.weakest_pull = 1e-3;
        smoother.strongest_pull = 0.1;
    }
    return smoother;
}

PathSmootherOptions HitchSmootherOptions(const Projection& view) {
    PathSmootherOptions smoother;
    smoother.weakest_pull = 0.03;
    smoother.strongest_pull = 3.0;
    smoother.wall = {8, view.IsRing() ? 0.02 : 8, view.IsRing() ? 0.02 : 0.03};
    return smoother;
}

TrailerPlacementOptions PlacementOptions(const Projection& canvas, double analysis_scale) {
    TrailerPlacementOptions options;
    if (canvas.IsRing()) options.gain = 0.3;
    options.robust.max_sigma_px /= analysis_scale;
    options.acquire.max_sigma_px /= analysis_scale;
    return options;
}

}  // namespace hitchview::algo
