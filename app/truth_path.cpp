#include "app/truth_path.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>

namespace hitchview::app {
namespace {

using algo::Unit;
using Eigen::Vector2d;

/// Continues an unrolled path to where the picture shows the point now, straight over `hidden`
/// frames.
void Append(const algo::Projection& picture, const Vector2d& shown_px, int hidden,
            std::vector<Vector2d>& path) {
    const Vector2d last = path.empty() ? shown_px : path.back();
    const Vector2d last_in_picture = path.empty() ? shown_px : picture.Pixel(picture.Ray(last));
    const Vector2d way = picture.Difference(shown_px, last_in_picture);
    for (int i = 1; i <= hidden + 1; ++i) path.push_back(last + i * way / (hidden + 1.0));
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
    for (const Unit unit : algo::kUnits) {
        const algo::Projection& view = sight_.geometry().units[unit]->view();
        for (std::size_t i = 0; i < kLandmarks; ++i) {
            const Sighting sighting = Look(unit, i, frame, composition);
            Segment& segment = open_[unit][i];
            if (sighting.camera != segment.camera || segment.hidden > kLongestHidden) {
                closed_[unit].push_back(std::exchange(segment, {}));
                segment.camera = sighting.camera;
            }
            if (sighting.camera < 0) continue;
            if (sight_.IsHidden(unit, sighting.camera, frame, landmarks_[i])) {
                if (!segment.view_px.empty()) ++segment.hidden;
            } else {
                Extend(sighting, view, segment);
            }
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

void TruthPath::Extend(const Sighting& sighting, const algo::Projection& view,
                       Segment& segment) const {
    Append(view, sighting.view_px, segment.hidden, segment.view_px);
    Append(sight_.geometry().canvas, sighting.canvas_px, segment.hidden, segment.canvas_px);
    segment.hidden = 0;
}

void TruthPath::AddTo(Shake& shake, const Segment& segment) const {
    shake.largest_px = std::max(shake.largest_px, LargestSecondDifference(segment.canvas_px));
    if (segment.canvas_px.size() < kShortest) return;
    const auto n = static_cast<double>(segment.canvas_px.size());
    shake.input_px += n * PowerOf(segment.view_px, rate_hz_);
    shake.output_px += n * PowerOf(segment.canvas_px, rate_hz_);
    shake.samples += static_cast<int>(segment.canvas_px.size());
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
