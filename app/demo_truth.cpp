#include "app/demo_truth.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>

namespace hitchview::app {
namespace {

using algo::Unit;
using drivers::SimulatedRig;
using Eigen::Vector2d;
using Eigen::Vector3d;

/// Rows of the seam that are looked at, in blocks of the map.
constexpr int kFirstRow = 3;
constexpr int kRowStep = 2;
/// Rays into the scene are dear, and neighbouring frame sets look alike.
constexpr int kSeamEvery = 5;  // frame sets

Vector2d SecondDifference(const algo::Projection& picture, const Vector2d& late,
                          const Vector2d& middle, const Vector2d& early) {
    return picture.Difference(late, middle) - picture.Difference(middle, early);
}

}  // namespace

TruthMeter::TruthMeter(const SimulatedRig& rig, const RigGeometry& geometry)
    : sight_(rig, geometry) {
    for (int i = 0; i < kLandmarks; ++i) {
        const double azimuth = 2 * std::numbers::pi * i / kLandmarks;
        const double elevation = (i % 3) * 0.08;  // level with the horizon and above
        landmarks_[static_cast<std::size_t>(i)] =
            SimulatedRig::kFar_m * Vector3d{std::cos(azimuth), std::sin(azimuth), elevation};
    }
}

void TruthMeter::Observe(const ShownPanorama& shown, const Pipeline& pipeline) {
    const int frame = static_cast<int>(shown.picture.header.sequence);
    for (const Unit unit : algo::kUnits) ObserveShake(unit, frame, *shown.composition);
    ObserveArticulation(frame, *shown.composition);
    if (frame % kSeamEvery != 0) return;
    for (const algo::Overlap overlap : algo::kOverlaps)
        ObserveSeam(overlap, frame, shown, pipeline);
}

void TruthMeter::ObserveShake(Unit unit, int frame, const algo::Composition& composition) {
    auto& [late, middle, early] = sightings_[unit];
    early = middle;
    middle = late;
    const algo::Projection& view = sight_.geometry().units[unit]->view();
    for (std::size_t i = 0; i < kLandmarks; ++i) {
        late[i] =
            sight_.Find(unit, frame, landmarks_[i], TruthSight::Occlusion::kIgnored, composition);
        // Another camera sees from another place: that step is parallax of the rig, not shake.
        if (late[i].camera < 0 || late[i].camera != middle[i].camera ||
            late[i].camera != early[i].camera)
            continue;
        input_squares_[unit] +=
            SecondDifference(view, late[i].view_px, middle[i].view_px, early[i].view_px)
                .squaredNorm();
        output_squares_[unit] += SecondDifference(sight_.geometry().canvas, late[i].canvas_px,
                                                  middle[i].canvas_px, early[i].canvas_px)
                                     .squaredNorm();
        ++shake_samples_[unit];
    }
}

void TruthMeter::ObserveArticulation(int frame, const algo::Composition& composition) {
    if (!composition.articulation) return;
    const double truth_rad = sight_.rig().ArticulationAt(frame);
    const double error_rad = std::abs(composition.articulation->angle_rad - truth_rad);
    articulation_squares_ += error_rad * error_rad;
    articulation_.largest_rad = std::max(articulation_.largest_rad, error_rad);
    articulation_.rms_rad = std::sqrt(articulation_squares_ / ++articulation_.samples);
}

TruthMeter::ArticulationError TruthMeter::ErrorOfArticulation() const {
    return articulation_;
}

void TruthMeter::ObserveSeam(algo::Overlap overlap, int frame, const ShownPanorama& shown,
                             const Pipeline& pipeline) {
    const algo::ComposedMap& map = pipeline.map();
    constexpr double kBlock = algo::ComposedMap::kBlock;
    for (int row = kFirstRow; row < map.block_rows() - kFirstRow; row += kRowStep) {
        const double seam_px = map.seam_px(overlap, row);
        const int col = std::clamp(static_cast<int>(std::lround((seam_px + 0.5) / kBlock)), 0,
                                   map.block_cols());
        const Vector2d canvas_px{col * kBlock - 0.5, row * kBlock - 0.5};
        for (int s = 0; s < map.cameras(); ++s) {
            const algo::ComposedMap::Corner& corner = map.corner(s, row, col);
            if (map.unit_of(s) != Unit::kTractor || corner.weight <= 0.1F) continue;
            const auto point = sight_.WorldPointAt(Unit::kTractor, map.camera_of(s), frame,
                                                   Vector2d(corner.x, corner.y));
            if (!point) continue;
            const Sighting other = sight_.Find(Unit::kTrailer, frame, point->p_world_m,
                                               TruthSight::Occlusion::kTested, *shown.composition);
            if (other.camera < 0) continue;
            seam_.push_back(
                {point->distance_m,
                 sight_.geometry().canvas.Difference(other.canvas_px, canvas_px).norm()});
        }
    }
}

TruthMeter::Shake TruthMeter::ShakeOf(Unit unit) const {
    const int n = shake_samples_[unit];
    if (n == 0) return {};
    return {std::sqrt(input_squares_[unit] / n), std::sqrt(output_squares_[unit] / n), n};
}

TruthMeter::Seam TruthMeter::SeamOf(double from_m, double to_m) const {
    std::vector<double> errors;
    for (const SeamSample& sample : seam_) {
        if (sample.distance_m >= from_m && sample.distance_m < to_m)
            errors.push_back(sample.error_px);
    }
    if (errors.empty()) return {};
    std::sort(errors.begin(), errors.end());
    return {errors[errors.size() / 2], errors[errors.size() * 95 / 100],
            static_cast<int>(errors.size())};
}

}  // namespace hitchview::app
