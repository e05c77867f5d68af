#include "algo/rig_motion.hpp"

#include <algorithm>

#include "algo/feature_mask.hpp"
#include "algo/parallax_search.hpp"

namespace hitchview::algo {
namespace {

using Eigen::Matrix3d;
using Eigen::Vector2d;
using Eigen::Vector2f;
using Eigen::Vector3d;

/// A searched overlap is tried this often; a descriptor match costs more than a guided one.
constexpr int kAcquireEvery = 6;
constexpr int kFewestCandidates = 12;
constexpr int kLockedInliers = 12;
constexpr int kCoastFrames = 60;
constexpr float kLatticePitch_px = 9;  // of the analysis view
/// Parallax between the units' cameras, two metres apart, of what is farther than the alignment
/// surface and of what is 8 m away.
constexpr float kFarthest_rad = -0.018F;
constexpr float kNearest_rad = 0.22F;
constexpr float kLatticeCorrelation = 0.8F;
constexpr float kLatticeTravel_px = 2;  // a search along the row ends this near

}  // namespace

/// Expects a feature where the placement and the guessed field put it.
class RigMotionEstimator::Guidance final : public Expectation {
 public:
    Guidance(const RigMotionEstimator& owner, const MatchGuess& guess, Overlap overlap,
             int& candidates, bool with_field = true)
        : owner_(owner),
          mesh_(owner.canvas_),
          guess_(guess),
          overlap_(overlap),
          candidates_(candidates),
          with_field_(with_field),
          M_canvas_view_{{guess.M_canvas_tractor, guess.M_shown_placed * guess.M_canvas_tractor *
                                                      owner.placement_->M_tractor_trailer()}} {}

    bool Expect(Unit unit, const Vector2f& pixel, Vector2f& other) const override {
        const Vector2d px = owner_.analysis_[unit]->view().ToView(pixel);
        const Vector3d ray = owner_.view(unit).Ray(px);
        const Matrix3d& M_canvas_unit = M_canvas_view_[unit];
        const Matrix3d& M_canvas_other = M_canvas_view_[Other(unit)];
        const Vector2d canvas_px = owner_.canvas_.Pixel(M_canvas_unit * ray);
        if (!InOverlap(canvas_px)) return false;
        const Vector2d e =
            with_field_ ? Sample(mesh_, guess_.discrepancy, canvas_px) : Vector2d(Vector2d::Zero());
        const Vector2d there =
            unit == Unit::kTractor ? Vector2d(canvas_px + e) : Vector2d(canvas_px - e);
        const Unit opposite = Other(unit);
        const Vector2d expected =
            owner_.view(opposite).Pixel(M_canvas_other.inverse() * owner_.canvas_.Ray(there));
        other = owner_.analysis_[opposite]->view().ToAnalysis(expected);
        if (!Allows(owner_.analysis_[opposite]->view().mask(), other)) return false;
        ++candidates_;
        return true;
    }

 private:
    bool InOverlap(const Vector2d& canvas_px) const {
        if (!owner_.canvas_.IsRing()) return overlap_ == Overlap::kRight;
        return (canvas_px.x() < owner_.canvas_.Centre().x()) == (overlap_ == Overlap::kLeft);
    }

    const RigMotionEstimator& owner_;
    Mesh mesh_;
    const MatchGuess& guess_;
    Overlap overlap_;
    int& candidates_;
    bool with_field_;
    PerUnit<Matrix3d> M_canvas_view_;
};

RigMotionEstimator::RigMotionEstimator(const Projection& canvas,
                                       const PerUnit<std::optional<UnitGeometry>>& geometry,
                                       const UnifiedVertexMotionOptions& options)
    : canvas_(canvas),
      tractor_view_(geometry[Unit::kTractor]->view()),
      stitch_(options.stitch),
      primed_(std::make_unique<RigMotion>()) {
    if (geometry[Unit::kTrailer]) trailer_view_ = geometry[Unit::kTrailer]->view();
    for (const Unit unit : kUnits) {
        if (!geometry[unit]) continue;
        analysis_[unit] =
            std::make_unique<UnitAnalysis>(*geometry[unit], AnalysisOptions(view(unit)));
    }
    if (trailer_view_) {
        const SemiSurroundView& a = analysis_[Unit::kTractor]->view();
        const SemiSurroundView& b = analysis_[Unit::kTrailer]->view();
        matcher_ = std::make_unique<ClassicalMatcher>(std::max(a.width_px(), b.width_px()),
                                                      std::max(a.height_px(), b.height_px()),
                                                      ClassicalMatcherOptions{});
        placement_ = std::make_unique<TrailerPlacement>(tractor_view_, *trailer_view_,
                                                        PlacementOptions(canvas, a.scale()));
        LayLattice();
        if (canvas.IsRing()) {
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
    for (const Overlap overlap : kOverlaps) frames_unmatched_[overlap] = kCoastFrames;
}

bool RigMotionEstimator::Prime(const RigFrames& frames, TaskRunner& runner) {
    if (!placement_ || !stitch_) return true;
    if (canvas_.IsRing()) placement_->Start(Matrix3d::Identity());
    Analyse(frames, runner, *primed_);
    return AcquireTrailer(*primed_);
}

void RigMotionEstimator::Estimate(const RigFrames& frames, const MatchGuess& guess,
                                  TaskRunner& runner, RigMotion& motion) {
    Analyse(frames, runner, motion);
    if (placement_ && stitch_) MatchUnits(guess, runner, motion);
}

void RigMotionEstimator::Analyse(const RigFrames& frames, TaskRunner& runner, RigMotion& motion) {
    runner.Run(units(), [&](int i) {
        const Unit unit = kUnits[static_cast<std::size_t>(i)];
        analysis_[unit]->Analyse(frames[unit], motion.intra[unit]);
        motion.features[unit] = motion.intra[unit].inliers;
    });
}

void RigMotionEstimator::MatchUnits(const MatchGuess& guess, TaskRunner& runner,
                                    RigMotion& motion) {
    placement_->Predict(motion.intra);
    for (const Overlap overlap : kOverlaps) {
        motion.inter[overlap].clear();
        motion.dense[overlap].clear();
    }
    const bool lost = !placement_->acquired() || LongUnmatched();
    if (lost && matched_ % kAcquireEvery == 0) {
        AcquireTrailer(motion);
    } else if (placement_->acquired()) {
        Guide(guess, runner, motion);
    }
    UpdateSeams(motion);
    motion.M_tractor_trailer = placement_->M_tractor_trailer();
    motion.placed = placement_->acquired();
    if (articulation_) motion.articulation = articulation_->Step(motion.intra, motion.inter);
    ++matched_;
}

/// No overlap has agreed with the placement for so long that it is searched from nothing.
bool RigMotionEstimator::LongUnmatched() const {
    return std::all_of(frames_unmatched_.of.begin(), frames_unmatched_.of.end(),
                       [](int frames) { return frames >= kCoastFrames; });
}

void RigMotionEstimator::Guide(const MatchGuess& guess, TaskRunner& runner, RigMotion& motion) {
    runner.Run(static_cast<int>(kOverlaps.size()),
               [&](int i) { GuideOverlap(guess, kOverlaps[static_cast<std::size_t>(i)], motion); });
    // Corners gather on near things; the lattice covers what is far just as well.
    placement_->Correct(canvas_.IsRing() ? motion.dense : motion.inter);
}

void RigMotionEstimator::GuideOverlap(const MatchGuess& guess, Overlap overlap, RigMotion& motion) {
    PerUnit<MatchView> views{
        {analysis_[Unit::kTractor]->match_view(), analysis_[Unit::kTrailer]->match_view()}};
    ViewPairs& pairs = view_pairs_[overlap];
    int& candidates = motion.candidates[overlap];
    candidates = 0;
    matcher_->Guide(views, Guidance{*this, guess, overlap, candidates}, pairs);
    ToViews(pairs, motion.inter[overlap]);
    int asked = 0;
    if (canvas_.IsRing()) {
        SearchLattice(views, Guidance{*this, guess, overlap, asked},
                      Guidance{*this, guess, overlap, asked, false}, overlap, pairs);
    } else {
        views[Unit::kTractor].features = lattice_;
        views[Unit::kTrailer].features = {};
        matcher_->Guide(views, Guidance{*this, guess, overlap, asked}, pairs);
    }
    ToViews(pairs, motion.dense[overlap]);
}

/// The trailer's cameras stand behind the tractor's, so what is nearer than the alignment surface
/// lies farther forward in the trailer's view, which looks back: on the left that is to the left.
void RigMotionEstimator::SearchLattice(const PerUnit<MatchView>& views, const Guidance& guidance,
                                       const Guidance& surface, Overlap overlap,
                                       ViewPairs& pairs) const {
    pairs.clear();
    const float sign = overlap == Overlap::kLeft ? -1.0F : 1.0F;
    const auto focal_px =
        static_cast<float>(analysis_[Unit::kTractor]->view().scale() * tractor_view_.focal_px);
    const ParallaxRange range{sign * kFarthest_rad * focal_px, sign * kNearest_rad * focal_px};
    PatchAlignmentOptions alignment;
    alignment.max_travel_px = kLatticeTravel_px;
    const MatchView& here = views[Unit::kTractor];
    const MatchView& there = views[Unit::kTrailer];
    for (const Vector2f& at : lattice_) {
        Vector2f base;
        Vector2f expected;
        if (!surface.Expect(Unit::kTractor, at, base)) continue;
        if (!guidance.Expect(Unit::kTractor, at, expected)) expected = base;
        const auto found = SearchAlongRow(here.pyramid->level(0), there.pyramid->level(0), at, base,
                                          expected, range);
        if (!found) continue;
        const auto match = AlignPatch(*here.pyramid, *there.pyramid, at, *found, 0, alignment);
        if (!match || match->correlation < kLatticeCorrelation ||
            !Allows(*there.mask, match->position_px)) {
            continue;
        }
        if (!pairs.push_back({at, match->position_px})) return;
    }
}

void RigMotionEstimator::ToViews(const ViewPairs& pairs, InterFeatures& features) const {
    for (const ViewPair& pair : pairs) {
        features.push_back({analysis_[Unit::kTractor]->view().ToView(pair.tractor_px),
                            analysis_[Unit::kTrailer]->view().ToView(pair.trailer_px)});
    }
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
    const PerUnit<MatchView> views{
        {analysis_[Unit::kTractor]->match_view(), analysis_[Unit::kTrailer]->match_view()}};
    ViewPairs& pairs = view_pairs_[Overlap::kLeft];
    const SemiSurroundView& tractor = analysis_[Unit::kTractor]->view();
    const SemiSurroundView& trailer = analysis_[Unit::kTrailer]->view();
    for (const Overlap overlap : kOverlaps) {
        motion.inter[overlap].clear();
        PerUnit<cv::Rect> regions{{cv::Rect(0, 0, tractor.width_px(), tractor.height_px()),
                                   cv::Rect(0, 0, trailer.width_px(), trailer.height_px())}};
        if (canvas_.IsRing()) {
            // Left of the vehicle lies left of the middle in the tractor's view, and right of it in
            // the trailer's, which looks back.
            const bool left = overlap == Overlap::kLeft;
            for (const Unit unit : kUnits) {
                cv::Rect& r = regions[unit];
                r.width /= 2;
                if (left == (unit == Unit::kTrailer)) r.x = r.width;
            }
        } else if (overlap == Overlap::kLeft) {
            continue;
        }
        matcher_->Acquire(views, regions, pairs);
        ToViews(pairs, motion.inter[overlap]);
    }
    return placement_->Acquire(motion.inter);
}

void RigMotionEstimator::UpdateSeams(RigMotion& motion) {
    for (const Overlap overlap : kOverlaps) {
        const int inliers = placement_->inliers()[overlap];
        motion.matches[overlap] = inliers;
        int& unmatched = frames_unmatched_[overlap];
        unmatched = inliers >= kLockedInliers ? 0 : std::min(unmatched + 1, kCoastFrames);
        if (unmatched == 0) {
            motion.seams[overlap] = SeamState::kLocked;
        } else if (!placement_->acquired() || motion.candidates[overlap] < kFewestCandidates) {
            motion.seams[overlap] = SeamState::kNoOverlap;
        } else {
            motion.seams[overlap] =
                unmatched < kCoastFrames ? SeamState::kCoast : SeamState::kReacquire;
        }
    }
}

}  // namespace hitchview::algo
