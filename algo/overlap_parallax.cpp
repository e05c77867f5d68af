#include "algo/overlap_parallax.hpp"

#include <algorithm>
#include <bit>
#include <cmath>
#include <limits>

#include "algo/feature_mask.hpp"
#include "algo/match_refinement.hpp"
#include "algo/multiversion.hpp"

namespace hitchview::algo {
namespace {

using Eigen::Matrix3d;
using Eigen::Vector2f;
using Eigen::Vector3d;
using Cost = SemiGlobalMatching::Cost;

/// Where one view shows nothing, all distances are alike.
constexpr Cost kUnseen = 20;

/// More than signatures can differ.
constexpr Cost kNoSignature = 64;

int NodesOver(int length_px, int pitch_px) {
    return (length_px + pitch_px - 1) / pitch_px;
}

/// Where things are in a picture: row by row.
struct Picture {
    int width_px;
    float right_px;  ///< the last column
    float bottom_px;
};

/// Places of the labels of a curve. What lies outside the picture is at its border.
HV_MULTIVERSION
void PlaceLabels(const OverlapParallax::Curve& curve, const Picture& picture, int labels,
                 int* __restrict places) {
    const float x0 = curve.start.x() + 0.5F;
    const float y0 = curve.start.y() + 0.5F;
    const float x1 = curve.linear.x();
    const float y1 = curve.linear.y();
    const float x2 = curve.square.x();
    const float y2 = curve.square.y();
    const Picture in = picture;
    for (int k = 0; k < labels; ++k) {
        const auto at = static_cast<float>(k);
        const float x = x0 + at * (x1 + at * x2);
        const float y = y0 + at * (y1 + at * y2);
        const auto u = static_cast<int>(std::min(std::max(x, 0.0F), in.right_px));
        const auto v = static_cast<int>(std::min(std::max(y, 0.0F), in.bottom_px));
        places[k] = v * in.width_px + u;
    }
}

/// How many bits of the signatures at the places differ from those of `here`; kNoSignature and more
/// where there is none.
HV_MULTIVERSION
void CountDifferences(const std::uint64_t* __restrict signatures, const int* __restrict places,
                      std::uint64_t here, int labels, Cost* __restrict differences) {
    for (int k = 0; k < labels; ++k) {
        const std::uint64_t difference = here ^ signatures[places[k]];
        differences[k] = static_cast<Cost>(static_cast<std::uint64_t>(std::popcount(difference)) +
                                           (difference >> 63U << 6U));
    }
}

/// From how the signatures differ.
HV_MULTIVERSION
void RateLabels(const Cost* __restrict bias, int labels, Cost* __restrict cost) {
    for (int k = 0; k < labels; ++k) {
        const auto biased = static_cast<Cost>(cost[k] + bias[k]);
        cost[k] =
            cost[k] >= kNoSignature ? kUnseen : std::min(biased, SemiGlobalMatching::kDearest);
    }
}

}  // namespace

OverlapParallax::OverlapParallax(const PerUnit<UnitGeometry>& geometry,
                                 const PerUnit<const SemiSurroundView*>& views, Overlap overlap,
                                 const OverlapParallaxOptions& options)
    : geometry_(geometry),
      views_(views),
      options_(options),
      first_px_(overlap == Overlap::kLeft ? 0 : views[Unit::kTractor]->width_px() / 2),
      end_px_(overlap == Overlap::kLeft ? views[Unit::kTractor]->width_px() / 2
                                        : views[Unit::kTractor]->width_px()),
      curve_rows_(NodesOver(views[Unit::kTractor]->height_px(), kCurvePitch_px) + 1),
      curve_cols_(NodesOver(end_px_ - first_px_, kCurvePitch_px) + 1),
      sights_(static_cast<std::size_t>(curve_rows_ * curve_cols_)),
      curves_(sights_.size()),
      census_{{Census(views[Unit::kTractor]->width_px(), views[Unit::kTractor]->height_px()),
               Census(views[Unit::kTrailer]->width_px(), views[Unit::kTrailer]->height_px())}},
      bias_(static_cast<std::size_t>(options.labels)),
      places_(bias_.size()),
      max_cols_(NodesOver(end_px_ - first_px_, kPitch_px)),
      reach_(NodesOver(views[Unit::kTractor]->height_px(), kRowPitch_px), max_cols_,
             options.labels),
      matching_(NodesOver(views[Unit::kTractor]->height_px(), kRowPitch_px), max_cols_,
                options.labels, options.matching),
      node_curves_(static_cast<std::size_t>(matching_.rows() * max_cols_)),
      matches_(node_curves_.size()) {
    const double surface = options_.beyond_per_m / Span_per_m() * (options_.labels - 1);
    for (int k = 0; k < options_.labels; ++k) {
        bias_[static_cast<std::size_t>(k)] =
            static_cast<Cost>(options_.surface_bias * std::abs(k - surface));
    }
    LookOut();
}

void OverlapParallax::LookOut() {
    const SemiSurroundView& view = *views_[Unit::kTractor];
    const UnitGeometry& tractor = geometry_[Unit::kTractor];
    for (int row = 0; row < curve_rows_; ++row) {
        for (int col = 0; col < curve_cols_; ++col) {
            const Vector2f at{static_cast<float>(first_px_ + kCurvePitch_px * col),
                              static_cast<float>(kCurvePitch_px * row)};
            Sight& sight = sights_[static_cast<std::size_t>(row * curve_cols_ + col)];
            sight.ray = tractor.view().Ray(view.ToView(at));
            const auto line = tractor.SightAlong(sight.ray);
            if (!line) continue;
            sight.line = *line;
            sight.surface_m = tractor.SurfaceDistance_m(line->origin_m, sight.ray);
            sight.known = true;
        }
    }
}

void OverlapParallax::Match(const PerUnit<MatchView>& views, const Matrix3d& R_tractor_trailer) {
    LayCurves(R_tractor_trailer);
    if (!ChooseColumns()) return;
    reach_.Start();
    Compare(views);
    matching_.Solve();
    TakeAnswers(views);
}

void OverlapParallax::LayCurves(const Matrix3d& R_tractor_trailer) {
    for (std::size_t i = 0; i < sights_.size(); ++i)
        curves_[i] = sights_[i].known ? CurveOf(sights_[i], R_tractor_trailer) : Curve{};
}

/// Of the camera that the trailer's view shows there. Above and below the view: of the one at its
/// border.
std::optional<SightLine> OverlapParallax::OtherSight(const Vector3d& ray) const {
    const SemiSurroundView& view = *views_[Unit::kTrailer];
    Vector2f at = view.ToAnalysis(geometry_[Unit::kTrailer].view().Pixel(ray));
    at.y() = std::clamp(at.y(), 0.0F, static_cast<float>(view.height_px() - 1));
    const auto camera = view.CameraAt(at);
    if (!camera) return std::nullopt;
    return geometry_[Unit::kTrailer].SightOf(*camera, ray);
}

/// A point at distance 1 / w on the tractor's line of sight lies, seen from the trailer's camera,
/// in the direction line + w (one camera - other camera), in the trailer's frame. This also means
/// something for w <= 0: behind what is infinitely far.
OverlapParallax::Curve OverlapParallax::CurveOf(const Sight& sight,
                                                const Matrix3d& R_tractor_trailer) const {
    const UnitGeometry& trailer = geometry_[Unit::kTrailer];
    const auto other = OtherSight(R_tractor_trailer.transpose() * sight.ray);
    if (!other) return {};
    const Vector3d direction = R_tractor_trailer.transpose() * sight.line.direction;
    const Vector3d apart_m = R_tractor_trailer.transpose() * sight.line.origin_m - other->origin_m;
    const double farthest_per_m = 1 / sight.surface_m - options_.beyond_per_m;
    const auto at = [&](double share) {
        const double w = farthest_per_m + share * Span_per_m();
        const Vector3d ray = trailer.RayToward(other->origin_m, direction + w * apart_m);
        return views_[Unit::kTrailer]->ToAnalysis(trailer.view().Pixel(ray));
    };
    const Vector2f far = at(0);
    const Vector2f middle = at(0.5);
    const Vector2f near = at(1);
    const auto last = static_cast<float>(options_.labels - 1);
    if ((near - far).norm() > 2 * last) return {};  // across the edge of the view
    Curve curve;
    curve.start = far;
    curve.linear = (4 * middle - 3 * far - near) / last;
    curve.square = (2 * far + 2 * near - 4 * middle) / (last * last);
    curve.known = true;
    return curve;
}

/// Those between the first and the last curve; false if there is none.
bool OverlapParallax::ChooseColumns() {
    int first = curve_cols_;
    int last = -1;
    for (std::size_t i = 0; i < curves_.size(); ++i) {
        if (!curves_[i].known) continue;
        const int col = static_cast<int>(i) % curve_cols_;
        first = std::min(first, col);
        last = std::max(last, col);
    }
    left_px_ = first_px_ + kCurvePitch_px * first;
    const int right_px = std::min(end_px_ - 1, first_px_ + kCurvePitch_px * last);
    matching_.Start(first > last ? 0 : std::min(max_cols_, (right_px - left_px_) / kPitch_px + 1));
    return first <= last;
}

/// Between the four curves round it.
OverlapParallax::Curve OverlapParallax::CurveAt(int x, int y) const {
    const int col = std::min((x - first_px_) / kCurvePitch_px, curve_cols_ - 2);
    const int row = std::min(y / kCurvePitch_px, curve_rows_ - 2);
    const float s = static_cast<float>(x - first_px_ - col * kCurvePitch_px) / kCurvePitch_px;
    const float t = static_cast<float>(y - row * kCurvePitch_px) / kCurvePitch_px;
    const Curve* top = curves_.data() + static_cast<std::ptrdiff_t>(row) * curve_cols_ + col;
    const Curve* bottom = top + curve_cols_;
    if (!top[0].known || !top[1].known || !bottom[0].known || !bottom[1].known) return {};
    const auto mix = [&](Vector2f Curve::*part) {
        return Vector2f((1 - t) * ((1 - s) * top[0].*part + s * top[1].*part) +
                        t * ((1 - s) * bottom[0].*part + s * bottom[1].*part));
    };
    return {mix(&Curve::start), mix(&Curve::linear), mix(&Curve::square), true};
}

/// The first and the last column of the trailer's view that a curve may reach: a curve lies between
/// the columns of the three points that span it as a parabola.
std::pair<int, int> OverlapParallax::TrailerColumns() const {
    const auto last = static_cast<float>(options_.labels - 1);
    std::pair<float, float> reach{std::numeric_limits<float>::max(), 0};
    for (const Curve& curve : curves_) {
        if (!curve.known) continue;
        const float middle = curve.start.x() + 0.5F * last * curve.linear.x();
        for (const float x : {curve.start.x(), middle, curve.At(last).x()})
            reach = {std::min(reach.first, x), std::max(reach.second, x)};
    }
    const auto width = static_cast<float>(views_[Unit::kTrailer]->width_px());
    return {static_cast<int>(std::clamp(reach.first, 0.0F, width)),
            static_cast<int>(std::clamp(reach.second + 1, 0.0F, width - 1))};
}

void OverlapParallax::Compare(const PerUnit<MatchView>& views) {
    const cv::Mat1b& picture = views[Unit::kTractor].pyramid->level(0);
    census_[Unit::kTractor].Build(picture, *views[Unit::kTractor].mask, left_px_, NodeX(cols() - 1),
                                  kRowPitch_px);
    const auto [first, last] = TrailerColumns();
    census_[Unit::kTrailer].Build(views[Unit::kTrailer].pyramid->level(0),
                                  *views[Unit::kTrailer].mask, first, last, 1);
    for (int row = 0; row < rows(); ++row) {
        for (int col = 0; col < cols(); ++col) {
            matching_.grey(row, col) = picture(NodeY(row), NodeX(col));
            CompareNode(row, col);
        }
    }
}

void OverlapParallax::CompareNode(int row, int col) {
    Cost* cost = matching_.costs(row, col);
    const int x = NodeX(col);
    const int y = NodeY(row);
    Curve& curve = NodeCurve(row, col);
    curve = HasSignature(x, y) ? CurveAt(x, y) : Curve{};
    const int tried = reach_.At(row, ColumnOf(col));
    matching_.tried(row, col) = static_cast<std::uint8_t>(tried);
    if (!curve.known) {
        std::fill(cost, cost + tried, kUnseen);
        return;
    }
    const Census& there = census_[Unit::kTrailer];
    const int width_px = views_[Unit::kTrailer]->width_px();
    const int height_px = views_[Unit::kTrailer]->height_px();
    PlaceLabels(curve,
                {width_px, static_cast<float>(width_px - 1), static_cast<float>(height_px - 1)},
                tried, places_.data());
    CountDifferences(there.data(), places_.data(), census_[Unit::kTractor].At(x, y), tried, cost);
    RateLabels(bias_.data(), tried, cost);
}

void OverlapParallax::TakeAnswers(const PerUnit<MatchView>& views) {
    for (int row = 0; row < rows(); ++row) {
        for (int col = 0; col < cols(); ++col) matches_[Index(row, col)] = MatchOf(views, row, col);
    }
}

std::optional<ParallaxMatch> OverlapParallax::MatchOf(const PerUnit<MatchView>& views, int row,
                                                      int col) {
    const int x = NodeX(col);
    const int y = NodeY(row);
    const Curve& curve = NodeCurve(row, col);
    if (!curve.known) {
        reach_.Note(row, ColumnOf(col), 0);  // takes what its neighbours take
        return std::nullopt;
    }
    const SemiGlobalMatching::Answer answer = matching_.AnswerAt(row, col);
    reach_.Note(row, ColumnOf(col), answer.label);
    Vector2f there = curve.At(static_cast<float>(answer.label) + answer.fraction);
    if (!Allows(*views[Unit::kTrailer].mask, there)) return std::nullopt;
    const float told = RefineMatch(views[Unit::kTractor].pyramid->level(0), x, y,
                                   views[Unit::kTrailer].pyramid->level(0), there);
    const Vector2f here{static_cast<float>(x), static_cast<float>(y)};
    return ParallaxMatch{{here, there}, told, answer.lead >= options_.clear_lead};
}

}  // namespace hitchview::algo
