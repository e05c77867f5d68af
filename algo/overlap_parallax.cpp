#include "algo/overlap_parallax.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

#include "algo/feature_mask.hpp"
#include "algo/match_refinement.hpp"

namespace hitchview::algo {
namespace {

using Eigen::Matrix3d;
using Eigen::Vector2f;
using Eigen::Vector3d;
using Cost = SemiGlobalMatching::Cost;

/// Where one view shows nothing, all distances are alike.
constexpr Cost kUnseen = 20;

int NodesOver(int length_px, int pitch_px) {
    return (length_px + pitch_px - 1) / pitch_px;
}

/// Number of set bits in each nibble.
std::uint16_t CountInNibbles(std::uint16_t word) {
    const auto pairs = static_cast<std::uint16_t>(word - (word >> 1U & 0x5555U));
    return static_cast<std::uint16_t>((pairs & 0x3333U) + (pairs >> 2U & 0x3333U));
}

/// Number of set bits in three words: in the sum of their bits at each place, a two-digit number.
std::uint16_t CountBits(std::uint16_t a, std::uint16_t b, std::uint16_t c) {
    const auto one_of_two = static_cast<std::uint16_t>(a ^ b);
    const auto ones = static_cast<std::uint16_t>(one_of_two ^ c);
    const auto twos = static_cast<std::uint16_t>((a & b) | (one_of_two & c));
    const auto nibbles =
        static_cast<std::uint16_t>(CountInNibbles(ones) + 2U * CountInNibbles(twos));
    const auto bytes = static_cast<std::uint16_t>((nibbles & 0x0F0FU) + (nibbles >> 4U & 0x0F0FU));
    return static_cast<std::uint16_t>((bytes + (bytes >> 8U)) & 0xFFU);
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
      matching_(NodesOver(views[Unit::kTractor]->height_px(), kRowPitch_px), max_cols_,
                options.labels, options.matching),
      matches_(static_cast<std::size_t>(matching_.rows() * max_cols_)) {
    differences_.fill(std::vector<std::uint16_t>(bias_.size()));
    const double surface = options_.beyond_per_m / Span_per_m() * (options_.labels - 1);
    for (int k = 0; k < options_.labels; ++k) {
        bias_[static_cast<std::size_t>(k)] =
            static_cast<std::uint16_t>(options_.surface_bias * std::abs(k - surface));
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
    Compare(views);
    matching_.Solve();
    TakeAnswers(views);
}

void OverlapParallax::LayCurves(const Matrix3d& R_tractor_trailer) {
    for (std::size_t i = 0; i < sights_.size(); ++i)
        curves_[i] = sights_[i].known ? CurveOf(sights_[i], R_tractor_trailer) : Curve{};
}

/// A point at distance 1 / w on the tractor's line of sight lies, seen from the trailer's camera,
/// in the direction line + w (one camera - other camera), in the trailer's frame. This also means
/// something for w <= 0: behind what is infinitely far.
OverlapParallax::Curve OverlapParallax::CurveOf(const Sight& sight,
                                                const Matrix3d& R_tractor_trailer) const {
    const UnitGeometry& trailer = geometry_[Unit::kTrailer];
    const auto other = trailer.SightAlong(R_tractor_trailer.transpose() * sight.ray);
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
    const Curve curve = CurveAt(x, y);
    if (!curve.known || !HasSignature(x, y)) {
        std::fill(cost, cost + options_.labels, kUnseen);
        return;
    }
    LookAlong(curve, census_[Unit::kTractor].At(x, y));
    RateLabels(cost);
}

/// From how the signatures differ.
void OverlapParallax::RateLabels(Cost* __restrict cost) const {
    const int labels = options_.labels;
    const std::uint16_t* bias = bias_.data();
    const std::uint16_t* a = differences_[0].data();
    const std::uint16_t* b = differences_[1].data();
    const std::uint16_t* c = differences_[2].data();
    const std::uint16_t* none = differences_[3].data();
    for (int k = 0; k < labels; ++k) {
        const auto seen = static_cast<std::uint16_t>(CountBits(a[k], b[k], c[k]) + bias[k]);
        const std::uint16_t rated = std::min<std::uint16_t>(seen, SemiGlobalMatching::kDearest);
        cost[k] = static_cast<Cost>(none[k] != 0 ? kUnseen : rated);
    }
}

/// Signatures along a curve against that of the node. What lies outside the picture is looked up at
/// its border, where there are none.
void OverlapParallax::LookAlong(const Curve& curve, std::uint64_t here) {
    const int width = views_[Unit::kTrailer]->width_px();
    const auto right = static_cast<float>(width - 1);
    const auto bottom = static_cast<float>(views_[Unit::kTrailer]->height_px() - 1);
    const int labels = options_.labels;
    int* places = places_.data();
    for (int k = 0; k < labels; ++k) {
        const auto at = static_cast<float>(k);
        const float x = curve.start.x() + at * (curve.linear.x() + at * curve.square.x()) + 0.5F;
        const float y = curve.start.y() + at * (curve.linear.y() + at * curve.square.y()) + 0.5F;
        const auto u = static_cast<int>(std::min(std::max(x, 0.0F), right));
        const auto v = static_cast<int>(std::min(std::max(y, 0.0F), bottom));
        places[k] = v * width + u;
    }
    const std::uint64_t* signatures = census_[Unit::kTrailer].data();
    auto& [first, second, third, fourth] = differences_;
    for (std::size_t k = 0; k < places_.size(); ++k) {
        const std::uint64_t difference = here ^ signatures[places[k]];
        first[k] = static_cast<std::uint16_t>(difference);
        second[k] = static_cast<std::uint16_t>(difference >> 16U);
        third[k] = static_cast<std::uint16_t>(difference >> 32U);
        fourth[k] = static_cast<std::uint16_t>(difference >> 48U);
    }
}

void OverlapParallax::TakeAnswers(const PerUnit<MatchView>& views) {
    for (int row = 0; row < rows(); ++row) {
        for (int col = 0; col < cols(); ++col) matches_[Index(row, col)] = MatchOf(views, row, col);
    }
}

std::optional<ParallaxMatch> OverlapParallax::MatchOf(const PerUnit<MatchView>& views, int row,
                                                      int col) const {
    const int x = NodeX(col);
    const int y = NodeY(row);
    const Curve curve = CurveAt(x, y);
    if (!curve.known || !HasSignature(x, y)) return std::nullopt;
    const SemiGlobalMatching::Answer answer = matching_.AnswerAt(row, col);
    Vector2f there = curve.At(static_cast<float>(answer.label) + answer.fraction);
    if (!Allows(*views[Unit::kTrailer].mask, there)) return std::nullopt;
    const float told = RefineMatch(views[Unit::kTractor].pyramid->level(0), x, y,
                                   views[Unit::kTrailer].pyramid->level(0), there);
    const Vector2f here{static_cast<float>(x), static_cast<float>(y)};
    return ParallaxMatch{{here, there}, told, answer.lead >= options_.clear_lead};
}

}  // namespace hitchview::algo
