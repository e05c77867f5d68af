#include "app/truth_path.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>

namespace hitchview::app {
namespace {

using algo::Unit;
using Eigen::Vector2d;

/// Continues an unrolled path to where the picture shows the point now.
void Append(const algo::Projection& picture, const Vector2d& shown_px,
            std::vector<Vector2d>& path) {
    const Vector2d last = path.empty() ? shown_px : path.back();
    const Vector2d last_in_picture = path.empty() ? shown_px : picture.Pixel(picture.Ray(last));
    path.push_back(last + picture.Difference(shown_px, last_in_picture));
}

/// Continues a path to `size` points, straight to `last`.
void Extrapolate(const Vector2d& last, std::size_t size, std::vector<Vector2d>& path) {
    const Vector2d first = path.empty() ? last : path.back();
    const auto steps = static_cast<double>(size - path.size());
    for (double i = 1; i <= steps; ++i) path.push_back(first + i / steps * (last - first));
}

double PowerOf(const std::vector<Vector2d>& path, double rate_hz) {
    double power = 0;
    for (const int axis : {0, 1}) {
        std::vector<double> values;
        for (const Vector2d& p : path) values.push_back(p[axis]);
        power += BandPower(values, rate_hz, TruthPath::kShake);
    }
    return power;
}

double LargestSecondDifference(const std::vector<Vector2d>& path) {
    double largest = 0;
    for (std::size_t i = 2; i < path.size(); ++i)
        largest = std::max(largest, (path[i] - 2 * path[i - 1] + path[i - 2]).norm());
    return largest;
}

}  // namespace

TruthPath::TruthPath(TruthSight& sight, double rate_hz) : sight_(sight), rate_hz_(rate_hz) {
    for (std::size_t i = 0; i < kLandmarks; ++i) {
        const double azimuth = 2 * std::numbers::pi * static_cast<double>(i) / kLandmarks;
        const double elevation = static_cast<double>(i % 3) * 0.08;  // horizon and above
        landmarks_[i] = drivers::SimulatedRig::kFar_m *
                        Eigen::Vector3d{std::cos(azimuth), std::sin(azimuth), elevation};
    }
}

void TruthPath::Observe(int frame, const algo::Composition& composition) {
    algo::Composition pose = composition;
    pose.discrepancy.setZero();
    pose.detail = {};
    for (const Unit unit : algo::kUnits) {
        for (std::size_t i = 0; i < kLandmarks; ++i) {
            const Sighting sighting = Look(unit, i, frame, composition);
            Segment& segment = open_[unit][i];
            const bool lost = segment.view_px.size() > segment.field_px.size() + kLongestHidden;
            if (sighting.camera != segment.camera || lost) {
                closed_[unit].push_back(std::exchange(segment, {}));
                segment.camera = sighting.camera;
            }
            if (sighting.camera >= 0) Extend(unit, i, frame, sighting, pose);
        }
    }
}

/// Stays with the camera that showed the landmark last as long as it can.
Sighting TruthPath::Look(Unit unit, std::size_t landmark, int frame,
                         const algo::Composition& composition) const {
    const int camera = open_[unit][landmark].camera;
    if (camera >= 0) {
        const Sighting again =
            sight_.Through(unit, camera, frame, landmarks_[landmark], composition);
        if (again.camera >= 0) return again;
    }
    return sight_.Find(unit, frame, landmarks_[landmark], TruthSight::Occlusion::kIgnored,
                       composition);
}

void TruthPath::Extend(Unit unit, std::size_t landmark, int frame, const Sighting& sighting,
                       const algo::Composition& pose) {
    Segment& segment = open_[unit][landmark];
    const algo::Projection& canvas = sight_.geometry().canvas;
    const bool hidden = sight_.IsHidden(unit, sighting.camera, frame, landmarks_[landmark]);
    if (hidden && segment.view_px.empty()) return;  // begins where it is seen
    const Vector2d posed_px =
        sight_.Through(unit, sighting.camera, frame, landmarks_[landmark], pose).canvas_px;
    Append(sight_.geometry().units[unit]->view(), sighting.view_px, segment.view_px);
    Append(canvas, posed_px, segment.posed_px);
    if (hidden) return;
    Extrapolate(canvas.Difference(sighting.canvas_px, posed_px), segment.view_px.size(),
                segment.field_px);
}

void TruthPath::AddTo(Shake& shake, const Segment& segment) const {
    std::vector<Vector2d> canvas_px = segment.field_px;
    for (std::size_t i = 0; i < canvas_px.size(); ++i) canvas_px[i] += segment.posed_px[i];
    const std::vector<Vector2d> view_px(
        segment.view_px.begin(),
        segment.view_px.begin() + static_cast<std::ptrdiff_t>(canvas_px.size()));
    shake.largest_px = std::max(shake.largest_px, LargestSecondDifference(canvas_px));
    if (canvas_px.size() < kShortest) return;
    const auto n = static_cast<double>(canvas_px.size());
    shake.input_px += n * PowerOf(view_px, rate_hz_);
    shake.output_px += n * PowerOf(canvas_px, rate_hz_);
    shake.samples += static_cast<int>(canvas_px.size());
}

TruthPath::Shake TruthPath::ShakeOf(Unit unit) const {
    Shake shake;
    for (const Segment& segment : closed_[unit]) AddTo(shake, segment);
    for (const Segment& segment : open_[unit]) AddTo(shake, segment);
    if (shake.samples == 0) return shake;
    shake.input_px = std::sqrt(shake.input_px / shake.samples);
    shake.output_px = std::sqrt(shake.output_px / shake.samples);
    return shake;
}

}  // namespace hitchview::app
