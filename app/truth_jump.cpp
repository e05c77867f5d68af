#include "app/truth_jump.hpp"

#include <algorithm>
#include <cmath>

#include "algo/unified_options.hpp"
#include "drivers/simulated_traffic.hpp"

namespace hitchview::app {
namespace {

using algo::ComposedMap;
using algo::Overlap;
using algo::PerUnit;
using algo::Unit;
using Eigen::Matrix3d;
using Eigen::Vector2d;
using Eigen::Vector3d;

/// With fewer points a median tells of single things.
constexpr std::size_t kFewestPoints = 10;
/// What a truck's box may exceed its nominal size by.
constexpr double kSlack_m = 0.3;
constexpr double kHalfTruckWidth_m = 1.3;

/// The camera of the tractor with the largest share in a corner; -1: none.
int Shower(const ComposedMap& map, int row, int col) {
    int best = -1;
    float most = 0;
    for (int s = 0; s < map.cameras() && map.unit_of(s) == Unit::kTractor; ++s) {
        const ComposedMap::Corner& corner = map.corner(s, row, col);
        if (!corner.sees || corner.weight <= most) continue;
        most = corner.weight;
        best = map.camera_of(s);
    }
    return best;
}

double Median(std::vector<double> values) {
    const auto middle = values.begin() + static_cast<std::ptrdiff_t>(values.size() / 2);
    std::nth_element(values.begin(), middle, values.end());
    return *middle;
}

bool Locked(const algo::Composition& composition, Overlap overlap) {
    return composition.seams[overlap] == algo::SeamState::kLocked;
}

/// Of `change`, what neither staying together nor following the scene explains: its way from the
/// nearest point between none and `of_scene`.
Vector2d Unexplained(const Vector2d& change, const Vector2d& of_scene) {
    const double share = change.dot(of_scene) / std::max(of_scene.squaredNorm(), 1e-9);
    return change - std::clamp(share, 0.0, 1.0) * of_scene;
}

}  // namespace

void TruthJump::Observe(int frame, const algo::Composition& used, const ComposedMap& map) {
    for (const Overlap overlap : algo::kOverlaps) ObserveSeam(overlap, frame, used, map);
    early_ = used;
    early_frame_ = frame;
    for (const Overlap overlap : algo::kOverlaps) {
        early_seam_px_[overlap].clear();
        for (int row = 0; row <= map.block_rows(); ++row)
            early_seam_px_[overlap].push_back(map.seam_px(overlap, row));
    }
}

void TruthJump::ObserveSeam(Overlap overlap, int frame, const algo::Composition& used,
                            const ComposedMap& map) {
    if (!Locked(used, overlap)) return;
    Figures& figures = figures_[overlap];
    const double seam_px = map.seam_px()[overlap];
    const Vector2d error_px = PlacementError(frame, used, seam_px);
    figures.placement_errors_px.push_back(error_px.norm());
    if (early_frame_ != frame - 1 || !Locked(early_, overlap)) return;
    const Vector2d early_px = PlacementError(frame - 1, early_, seam_px);
    figures.largest_placement_px =
        std::max(figures.largest_placement_px, (error_px - early_px).norm());
    std::vector<double> x;
    std::vector<double> y;
    for (int row = 0; row <= map.block_rows(); ++row) {
        const auto change = ChangeAt(overlap, frame, used, map, row);
        if (!change) continue;
        x.push_back(change->x());
        y.push_back(change->y());
    }
    if (x.size() < kFewestPoints) return;
    ++figures.frames;
    figures.largest_seam_px = std::max(figures.largest_seam_px, std::hypot(Median(x), Median(y)));
}

std::optional<TruthJump::Change> TruthJump::ChangeAt(Overlap overlap, int frame,
                                                     const algo::Composition& used,
                                                     const ComposedMap& map, int row) {
    const auto nearest = std::lround((map.seam_px(overlap, row) + 0.5) / map.block_px());
    const int col = std::clamp(static_cast<int>(nearest), 0, map.block_cols());
    const int camera = Shower(map, row, col);
    if (camera < 0) return std::nullopt;
    const ComposedMap::Corner& corner = map.corner(camera, row, col);
    const auto point =
        sight_.WorldPointAt(Unit::kTractor, camera, frame, Vector2d(corner.x, corner.y));
    if (!point) return std::nullopt;
    const Sighting trailer =
        sight_.Find(Unit::kTrailer, frame, point->p_world_m, TruthSight::Occlusion::kTested, used);
    if (trailer.camera < 0) return std::nullopt;
    const auto shown = [&](int at, const Vector3d& p_world_m,
                           const algo::Composition& composition) {
        return PerUnit<Sighting>{
            {sight_.Through(Unit::kTractor, camera, at, p_world_m, composition),
             sight_.Through(Unit::kTrailer, trailer.camera, at, p_world_m, composition)}};
    };
    const auto [late_a, late_b] = shown(frame, point->p_world_m, used).of;
    const Vector3d early_m = OneFrameBefore(frame, point->p_world_m);
    const auto [early_a, early_b] = shown(frame - 1, early_m, early_).of;
    if (late_a.camera < 0 || late_b.camera < 0 || early_a.camera < 0 || early_b.camera < 0)
        return std::nullopt;
    if (!WasOnSeam(overlap, map, early_a.canvas_px)) return std::nullopt;
    const algo::Projection& canvas = sight_.geometry().canvas;
    const PerUnit<int> cameras{{camera, trailer.camera}};
    return Unexplained(canvas.Difference(late_b.canvas_px, late_a.canvas_px) -
                           canvas.Difference(early_b.canvas_px, early_a.canvas_px),
                       Parallax(cameras, frame, point->p_world_m, used) -
                           Parallax(cameras, frame - 1, early_m, early_));
}

/// Of a point between two cameras, on a canvas that places the trailer as it truly stands, px.
Vector2d TruthJump::Parallax(const PerUnit<int>& cameras, int frame, const Vector3d& p_world_m,
                             const algo::Composition& composition) const {
    const algo::Projection& canvas = sight_.geometry().canvas;
    const Matrix3d M_canvas_world = composition.M_canvas_view[Unit::kTractor] *
                                    rig_.PoseAt(frame, Unit::kTractor).linear().transpose();
    const auto seen = [&](Unit unit) {
        const int camera = sight_.RigCamera(unit, cameras[unit]);
        return canvas.Pixel(M_canvas_world *
                            (p_world_m - rig_.CameraPoseAt(camera, frame).translation()));
    };
    return canvas.Difference(seen(Unit::kTrailer), seen(Unit::kTractor));
}

/// So near that the detail counted fully there.
bool TruthJump::WasOnSeam(Overlap overlap, const ComposedMap& map,
                          const Vector2d& canvas_px) const {
    const double core_px = algo::ShownDetailOptions(sight_.geometry().canvas, early_.kappa).core_px;
    const auto row = std::lround((canvas_px.y() + 0.5) / map.block_px());
    const auto& seam_px = early_seam_px_[overlap];
    if (row < 0 || row >= static_cast<long>(seam_px.size())) return false;
    return std::abs(canvas_px.x() - seam_px[static_cast<std::size_t>(row)]) <= core_px;
}

/// What is on a truck moves with it; trucks drive on straight roads only.
Vector3d TruthJump::OneFrameBefore(int frame, const Vector3d& p_world_m) const {
    const drivers::SimulationOptions& options = rig_.options();
    const double period_s = std::chrono::duration<double>(options.period).count();
    for (const drivers::SceneOptions::Truck& truck : options.scene.trucks) {
        const double along_m = truck.start_m + truck.speed_mps * frame * period_s;
        const bool on_it =
            std::abs(p_world_m.x() - along_m) < drivers::Traffic::kTruckLength_m / 2 + kSlack_m &&
            std::abs(p_world_m.y() - truck.across_m) < kHalfTruckWidth_m + kSlack_m &&
            p_world_m.z() > 0.02;
        if (on_it) return p_world_m - Vector3d(truck.speed_mps * period_s, 0, 0);
    }
    return p_world_m;
}

Vector2d TruthJump::PlacementError(int frame, const algo::Composition& composition,
                                   double seam_px) const {
    const algo::Projection& canvas = sight_.geometry().canvas;
    const Matrix3d R_tractor_trailer = rig_.PoseAt(frame, Unit::kTractor).linear().transpose() *
                                       rig_.PoseAt(frame, Unit::kTrailer).linear();
    const Vector2d at(seam_px, canvas.horizon_y_px);
    const Vector3d tractor_ray =
        composition.M_canvas_view[Unit::kTractor].inverse() * canvas.Ray(at);
    const Vector3d trailer_ray = R_tractor_trailer.transpose() * tractor_ray;
    return canvas.Difference(canvas.Pixel(composition.M_canvas_view[Unit::kTrailer] * trailer_ray),
                             at);
}

}  // namespace hitchview::app
