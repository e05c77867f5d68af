#include "algo/rig_motion.hpp"

#include <algorithm>
#include <numbers>

#include "algo/feature_mask.hpp"
#include "algo/guidance.hpp"
#include "algo/overlap_regions.hpp"

namespace hitchview::algo {
namespace {

using Eigen::Matrix3d;
using Eigen::Vector2f;

/// A searched overlap is tried this often; a descriptor match costs more than a guided one.
constexpr int kAcquireEvery = 6;
constexpr int kFewestCandidates = 12;
constexpr int kLockedInliers = 12;
constexpr double kLockedShare = 0.25;  // of the pairs
/// How far the trailer may be from where it is predicted when only the overlaps are searched.
constexpr double kSearched_rad = 5 * std::numbers::pi / 180;
constexpr float kLatticePitch_px = 9;  // of the analysis view
/// Nodes of the parallax grid from one pair for the placement to the next.
constexpr int kPlacementStep = 4;
constexpr float kPlacementWeight = 0.5F;  // of a match's texture

/// Of a ring's two overlaps; all round where there are none.
double NarrowerOverlap_rad(const PerUnit<std::optional<UnitGeometry>>& geometry) {
    const auto& [tractor, trailer] = geometry.of;
    if (!trailer || !trailer->view().IsRing()) return 2 * std::numbers::pi;
    const PerUnit<UnitGeometry> both{{*tractor, *trailer}};
    return std::min(OverlapWidth_rad(both, Overlap::kLeft),
                    OverlapWidth_rad(both, Overlap::kRight));
}

}  // namespace

RigMotionEstimator::RigMotionEstimator(const Projection& canvas,
                                       const PerUnit<std::optional<UnitGeometry>>& geometry,
                                       const UnifiedVertexMotionOptions& options)
    : canvas_(canvas),
      tractor_view_(geometry[Unit::kTractor]->view()),
      stitch_(options.stitch),
      primed_(std::make_unique<RigMotion>()) {
    if (geometry[Unit::kTrailer]) trailer_view_ = geometry[Unit::kTrailer]->view();
    const double overlap_rad = NarrowerOverlap_rad(geometry);
    for (const Unit unit : kUnits) {
        if (!geometry[unit]) continue;
        analysis_[unit] = std::make_unique<UnitAnalysis>(*geometry[unit],
                                                         AnalysisOptions(view(unit), overlap_rad));
    }
    if (trailer_view_) {
        const SemiSurroundView& a = analysis_[Unit::kTractor]->view();
        const SemiSurroundView& b = analysis_[Unit::kTrailer]->view();
        matcher_ = std::make_unique<ClassicalMatcher>(std::max(a.width_px(), b.width_px()),
                                                      std::max(a.height_px(), b.height_px()),
                                                      ClassicalMatcherOptions{});
        placement_ = std::make_unique<TrailerPlacement>(tractor_view_, *trailer_view_,
                                                        PlacementOptions(canvas, a.scale()));
        if (!canvas.IsRing()) {
            LayLattice();
        } else {
            for (const Overlap overlap : kOverlaps) {
                parallax_[overlap] = std::make_unique<OverlapParallax>(
                    PerUnit<UnitGeometry>{{*geometry[Unit::kTractor], *geometry[Unit::kTrailer]}},
                    PerUnit<const SemiSurroundView*>{{&a, &b}}, overlap, OverlapParallaxOptions{});
            }
            articulation_ = std::make_unique<ArticulationEstimator>(
                *geometry[Unit::kTractor], *geometry[Unit::kTrailer], ArticulationOptions{});
        }
    }
    Reset();
}

RigMotionEstimator::~RigMotionEstimator() = default;

void RigMotionEstimator::Reset() {
    matched_ = 0;
    for (const Unit unit : kUnits) {
        if (analysis_[unit]) analysis_[unit]->Reset();
    }
    if (articulation_) articulation_->Reset();
    for (const Overlap overlap : kOverlaps) {
        if (parallax_[overlap]) parallax_[overlap]->Reset();
        seams_[overlap].Reset();
        matches_[overlap] = 0;
    }
}

bool RigMotionEstimator::Prime(const RigFrames& frames, TaskRunner& runner) {
    if (!placement_ || !stitch_) return true;
    if (canvas_.IsRing()) placement_->Start(Matrix3d::Identity());
    Analyse(frames, runner, *primed_);
    return AcquireTrailer(*primed_);
}

void RigMotionEstimator::Estimate(const RigFrames& frames, const MatchGuess& guess,
                                  TaskRunner& runner, RigMotion& motion, RigParallax* parallax) {
    Analyse(frames, runner, motion);
    if (placement_ && stitch_) FollowTrailer(guess, runner, motion, parallax);
}

void RigMotionEstimator::Analyse(const RigFrames& frames, TaskRunner& runner, RigMotion& motion) {
    runner.Run(units(), [&](int i) {
        const Unit unit = kUnits[static_cast<std::size_t>(i)];
        analysis_[unit]->Analyse(frames[unit], motion.intra[unit]);
        motion.features[unit] = motion.intra[unit].inliers;
    });
}

void RigMotionEstimator::FollowTrailer(const MatchGuess& guess, TaskRunner& runner,
                                       RigMotion& motion, RigParallax* parallax) {
    placement_->Predict(motion.intra);
    for (const Overlap overlap : kOverlaps) {
        motion.inter[overlap].clear();
        motion.dense[overlap].clear();
        if (parallax != nullptr) (*parallax)[overlap].clear();
    }
    motion.matched = guess.match;
    if (guess.match) MatchUnits(guess, runner, motion, parallax);
    for (const Overlap overlap : kOverlaps) motion.seams[overlap] = seams_[overlap].state();
    motion.matches = matches_;
    motion.M_tractor_trailer = placement_->M_tractor_trailer();
    motion.placed = placement_->acquired();
    if (articulation_) motion.articulation = articulation_->Step(motion.intra, motion.dense);
}

void RigMotionEstimator::MatchUnits(const MatchGuess& guess, TaskRunner& runner, RigMotion& motion,
                                    RigParallax* parallax) {
    const bool lost = !placement_->acquired() || LongUnmatched();
    if (lost && matched_ % kAcquireEvery == 0) {
        AcquireTrailer(motion);
        for (const Overlap overlap : kOverlaps) motion.inter[overlap].clear();
    }
    if (placement_->acquired()) Guide(guess, runner, motion, parallax);
    UpdateSeams(motion);
    ++matched_;
}

/// No overlap has agreed with the placement for so long that it is searched from nothing.
bool RigMotionEstimator::LongUnmatched() const {
    return std::all_of(seams_.of.begin(), seams_.of.end(),
                       [](const SeamHysteresis& seam) { return seam.LongUnmatched(); });
}

void RigMotionEstimator::Guide(const MatchGuess& guess, TaskRunner& runner, RigMotion& motion,
                               RigParallax* parallax) {
    runner.Run(static_cast<int>(kOverlaps.size()), [&](int i) {
        const Overlap overlap = kOverlaps[static_cast<std::size_t>(i)];
        motion.candidates[overlap] = 0;
        if (canvas_.IsRing()) {
            MatchDensely(overlap, motion, parallax != nullptr ? &(*parallax)[overlap] : nullptr);
        } else {
            GuideOverlap(guess, overlap, motion);
        }
    });
    placement_->Correct(canvas_.IsRing() ? motion.dense : motion.inter);
}

PerUnit<MatchView> RigMotionEstimator::MatchViews() const {
    return {{analysis_[Unit::kTractor]->match_view(), analysis_[Unit::kTrailer]->match_view()}};
}

void RigMotionEstimator::GuideOverlap(const MatchGuess& guess, Overlap overlap, RigMotion& motion) {
    PerUnit<MatchView> views = MatchViews();
    const PerUnit<Guidance::Side> sides{
        {Guidance::Side{&analysis_[Unit::kTractor]->view(), tractor_view_, guess.M_canvas_tractor},
         Guidance::Side{
             &analysis_[Unit::kTrailer]->view(), *trailer_view_,
             guess.M_shown_placed * guess.M_canvas_tractor * placement_->M_tractor_trailer()}}};
    ViewPairs& pairs = view_pairs_[overlap];
    matcher_->Guide(
        views, Guidance(canvas_, sides, guess.discrepancy, overlap, motion.candidates[overlap]),
        pairs);
    ToViews(pairs, motion.inter[overlap]);
    int asked = 0;
    views[Unit::kTractor].features = lattice_;
    views[Unit::kTrailer].features = {};
    matcher_->Guide(views, Guidance(canvas_, sides, guess.discrepancy, overlap, asked), pairs);
    ToViews(pairs, motion.dense[overlap]);
}

void RigMotionEstimator::MatchDensely(Overlap overlap, RigMotion& motion,
                                      ParallaxSamples* samples) {
    OverlapParallax& parallax = *parallax_[overlap];
    parallax.Match(MatchViews(), placement_->M_tractor_trailer());
    for (int row = 0; row < parallax.rows(); ++row) {
        for (int col = 0; col < parallax.cols(); ++col) {
            const auto& match = parallax.At(row, col);
            if (!match) continue;
            const InterFeature pair = ToViews(match->pair);
            if (samples != nullptr) samples->push_back({pair, match->weight});
            if (row % kPlacementStep != 0 || col % kPlacementStep != 0) continue;
            ++motion.candidates[overlap];
            if (match->clear && match->weight > kPlacementWeight)
                motion.dense[overlap].push_back(pair);
        }
    }
}

InterFeature RigMotionEstimator::ToViews(const ViewPair& pair) const {
    return {analysis_[Unit::kTractor]->view().ToView(pair.tractor_px),
            analysis_[Unit::kTrailer]->view().ToView(pair.trailer_px)};
}

void RigMotionEstimator::ToViews(const ViewPairs& pairs, InterFeatures& features) const {
    for (const ViewPair& pair : pairs) features.push_back(ToViews(pair));
}

/// The field needs to be known where no corners are, too.
void RigMotionEstimator::LayLattice() {
    const SemiSurroundView& view = analysis_[Unit::kTractor]->view();
    for (float y = kLatticePitch_px / 2; y < static_cast<float>(view.height_px());
         y += kLatticePitch_px) {
        for (float x = kLatticePitch_px / 2; x < static_cast<float>(view.width_px());
             x += kLatticePitch_px) {
            if (Allows(view.mask(), {x, y})) lattice_.push_back({x, y});
        }
    }
}

bool RigMotionEstimator::AcquireTrailer(RigMotion& motion) {
    const PerUnit<MatchView> views = MatchViews();
    ViewPairs& pairs = view_pairs_[Overlap::kLeft];
    for (const Overlap overlap : kOverlaps) {
        motion.inter[overlap].clear();
        if (!canvas_.IsRing() && overlap == Overlap::kLeft) continue;
        matcher_->Acquire(views, SearchedRegions(overlap), pairs);
        ToViews(pairs, motion.inter[overlap]);
    }
    ++searches_;
    return placement_->Acquire(motion.inter);
}

/// On a ring in turns: what should overlap, which is little to search, and the whole side.
PerUnit<cv::Rect> RigMotionEstimator::SearchedRegions(Overlap overlap) const {
    const SemiSurroundView& tractor = analysis_[Unit::kTractor]->view();
    const SemiSurroundView& trailer = analysis_[Unit::kTrailer]->view();
    if (!canvas_.IsRing()) {
        return {{cv::Rect(0, 0, tractor.width_px(), tractor.height_px()),
                 cv::Rect(0, 0, trailer.width_px(), trailer.height_px())}};
    }
    const PerUnit<AnalysedRing> rings{
        {AnalysedRing{&tractor, tractor_view_}, AnalysedRing{&trailer, *trailer_view_}}};
    if (searches_ % 2 != 0) return SideRegions(rings, overlap);
    return OverlapRegions(rings, placement_->M_tractor_trailer(), overlap, kSearched_rad);
}

void RigMotionEstimator::UpdateSeams(const RigMotion& motion) {
    for (const Overlap overlap : kOverlaps) {
        const int inliers = placement_->inliers()[overlap];
        matches_[overlap] = inliers;
        const InterFeatures& pairs =
            canvas_.IsRing() ? motion.dense[overlap] : motion.inter[overlap];
        const bool matched = inliers >= kLockedInliers &&
                             inliers >= kLockedShare * static_cast<double>(pairs.size());
        seams_[overlap].Update(
            {matched, placement_->acquired(), motion.candidates[overlap] >= kFewestCandidates});
    }
}

}  // namespace hitchview::algo
