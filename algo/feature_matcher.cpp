#include "algo/feature_matcher.hpp"

#include <algorithm>

#include "algo/feature_mask.hpp"

namespace hitchview::algo {
namespace {

using Eigen::Vector2f;

struct Nearest {
    int index = -1;
    int distance = 257;
    int second = 257;
};

template <typename Corners>
Nearest FindNearest(const PatchDescriptor& wanted, const Corners& corners) {
    Nearest n;
    for (int i = 0; i < corners.count(); ++i) {
        const int d = wanted.Distance(corners[static_cast<std::size_t>(i)].descriptor);
        if (d < n.distance) {
            n = {i, d, n.distance};
        } else {
            n.second = std::min(n.second, d);
        }
    }
    return n;
}

/// Detectors for the levels of a picture of this size; levels too small for it get a tiny one.
std::array<CornerDetector, GreyPyramid::kMaxLevels> Detectors(
    int width, int height, const CornerDetectorOptions& options) {
    const auto at = [&](int l) {
        const int step = 1 << l;
        return CornerDetector((width + step - 1) / step, (height + step - 1) / step, options);
    };
    return {at(0), at(1), at(2), at(3), at(4)};
}

}  // namespace

ClassicalMatcher::ClassicalMatcher(int width_px, int height_px,
                                   const ClassicalMatcherOptions& options)
    : options_(options), detectors_(Detectors(width_px, height_px, options.corners)) {
    for (std::size_t l = 0; l < allowed_.size(); ++l) {
        allowed_[l] = cv::Mat1b::zeros(detectors_[l].strength().size());
    }
}

void ClassicalMatcher::DoGuide(const PerUnit<MatchView>& views, const Expectation& expectation,
                               ViewPairs& pairs) {
    pairs.clear();
    for (const Unit unit : kUnits) GuideFrom(unit, views, expectation, pairs);
}

void ClassicalMatcher::GuideFrom(Unit unit, const PerUnit<MatchView>& views,
                                 const Expectation& expectation, ViewPairs& pairs) const {
    // Half of the room for each direction.
    const std::size_t room =
        pairs.size() + (kMaxInterFeatures - pairs.size()) / (unit == Unit::kTractor ? 2 : 1);
    for (const Vector2f& feature : views[unit].features) {
        if (pairs.size() >= room) return;
        Vector2f expected;
        ViewPair pair;
        if (expectation.Expect(unit, feature, expected) &&
            Align(views, unit, feature, expected, options_.guided_level, pair)) {
            pairs.push_back(pair);
        }
    }
}

bool ClassicalMatcher::Align(const PerUnit<MatchView>& views, Unit from, const Vector2f& at,
                             const Vector2f& guess, int coarsest, ViewPair& pair) const {
    const MatchView& here = views[from];
    const MatchView& there = views[Other(from)];
    const auto match =
        AlignPatch(*here.pyramid, *there.pyramid, at, guess, coarsest, options_.alignment);
    if (!match || match->correlation < options_.min_correlation ||
        !Allows(*there.mask, match->position_px)) {
        return false;
    }
    const auto back =
        AlignPatch(*there.pyramid, *here.pyramid, match->position_px, at, 0, options_.alignment);
    if (!back || (back->position_px - at).norm() > options_.max_round_trip_px) return false;
    pair = from == Unit::kTractor ? ViewPair{at, match->position_px}
                                  : ViewPair{match->position_px, at};
    return true;
}

void ClassicalMatcher::DoAcquire(const PerUnit<MatchView>& views, const PerUnit<cv::Rect>& regions,
                                 ViewPairs& pairs) {
    pairs.clear();
    for (const Unit unit : kUnits) Describe(views[unit], regions[unit], described_[unit]);
    const DescribedCorners& tractor = described_[Unit::kTractor];
    const DescribedCorners& trailer = described_[Unit::kTrailer];
    for (int i = 0; i < tractor.count(); ++i) {
        const Described& corner = tractor[static_cast<std::size_t>(i)];
        const Nearest there = FindNearest(corner.descriptor, trailer);
        if (there.index < 0 || there.distance > options_.max_distance ||
            static_cast<float>(there.distance) >
                options_.max_distance_ratio * static_cast<float>(there.second)) {
            continue;
        }
        const Described& match = trailer[static_cast<std::size_t>(there.index)];
        if (FindNearest(match.descriptor, tractor).index != i) continue;
        ViewPair pair{corner.position_px, match.position_px};
        // Corners of coarse levels are known to a few pixels only: align them, else keep them.
        ViewPair aligned;
        if (Align(views, Unit::kTractor, pair.tractor_px, pair.trailer_px, 1, aligned))
            pair = aligned;
        if (!pairs.push_back(pair)) return;
    }
}

/// `mask` within `region`, at the size of a level: so a small region gets all the corners.
const cv::Mat1b& ClassicalMatcher::AllowedAt(int level, const cv::Mat1b& mask,
                                             const cv::Rect& region) {
    cv::Mat1b& allowed = allowed_[static_cast<std::size_t>(level)];
    // Unlike cv::Mat::setTo, takes no memory.
    std::fill_n(allowed[0], allowed.total(), std::uint8_t{0});
    const int step = 1 << level;
    const auto first = [step](int from) { return (from + step - 1) / step; };
    for (int y = first(region.y); step * y < region.br().y; ++y) {
        for (int x = first(region.x); step * x < region.br().x; ++x)
            allowed(y, x) = mask(step * y, step * x);
    }
    return allowed;
}

void ClassicalMatcher::Describe(const MatchView& view, const cv::Rect& region,
                                DescribedCorners& described) {
    described.clear();
    const int levels = std::min(options_.descriptor_levels, view.pyramid->levels() - 1);
    for (int l = 0; l < levels; ++l) {
        const auto scale = static_cast<float>(1 << l);
        detectors_[static_cast<std::size_t>(l)].Detect(view.pyramid->level(l),
                                                       AllowedAt(l, *view.mask, region), {},
                                                       options_.corners_per_level, corners_);
        for (const Corner& corner : corners_) {
            const Vector2f at = corner.position_px * scale;
            const auto descriptor = DescribePatch(*view.pyramid, l, corner.position_px);
            if (descriptor) described.push_back({at, *descriptor});
        }
    }
}

}  // namespace hitchview::algo
