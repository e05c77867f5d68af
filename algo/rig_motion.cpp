#include "algo/rig_motion.hpp"

#include <algorithm>

#include "algo/feature_mask.hpp"

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

}  // namespace

/// Expects a feature where the placement and the guessed field put it.
class RigMotionEstimator::Guidance final : public Expectation {
 public:
    Guidance(const RigMotionEstimator& owner, const MatchGuess& guess, Overlap overlap,
             int& candidates)
        : owner_(owner),
          mesh_(owner.canvas_),
          guess_(guess),
          overlap_(overlap),
          candidates_(candidates),
          M_canvas_view_{{guess.M_canvas_tractor, guess.M_shown_placed * guess.M_canvas_tractor *
                                                      owner.placement_->M_tractor_trailer()}} {}

    bool Expect(Unit unit, const Vector2f& pixel, Vector2f& other) const override {
        const Vector2d px = owner_.analysis_[unit]->view().ToView(pixel);
        const Vector3d ray = owner_.view(unit).Ray(px);
        const Matrix3d& M_canvas_unit = M_canvas_view_[unit];
        const Matrix3d& M_canvas_other = M_canvas_view_[Other(unit)];
        const Vector2d canvas_px = owner_.canvas_.Pixel(M_canvas_unit * ray);
        if (!InOverlap(canvas_px)) return false;
        const Vector2d e = Sample(mesh_, guess_.discrepancy, canvas_px);
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
    if (placement_ && stitch_) MatchUnits(guess, motion);
}

void RigMotionEstimator::Analyse(const RigFrames& frames, TaskRunner& runner, RigMotion& motion) {
    runner.Run(units(), [&](int i) {
        const Unit unit = kUnits[static_cast<std::size_t>(i)];
        analysis_[unit]->Analyse(frames[unit], motion.intra[unit]);
        motion.features[unit] = motion.intra[unit].inliers;
    });
}

void RigMotionEstimator::MatchUnits(const MatchGuess& guess, RigMotion& motion) {
    placement_->Predict(motion.intra);
    for (const Overlap overlap : kOverlaps) motion.inter[overlap].clear();
    const bool lost = !placement_->acquired() || LongUnmatched();
    if (lost && matched_ % kAcquireEvery == 0) {
        AcquireTrailer(motion);
    } else if (placement_->acquired()) {
        Guide(guess, motion);
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

void RigMotionEstimator::Guide(const MatchGuess& guess, RigMotion& motion) {
    const PerUnit<MatchView> views{
        {analysis_[Unit::kTractor]->match_view(), analysis_[Unit::kTrailer]->match_view()}};
    for (const Overlap overlap : kOverlaps) {
        motion.candidates[overlap] = 0;
        matcher_->Guide(views, Guidance{*this, guess, overlap, motion.candidates[overlap]},
                        view_pairs_);
        for (const ViewPair& pair : view_pairs_) {
            motion.inter[overlap].push_back(
                {analysis_[Unit::kTractor]->view().ToView(pair.tractor_px),
                 analysis_[Unit::kTrailer]->view().ToView(pair.trailer_px)});
        }
    }
    placement_->Correct(motion.inter);
}

bool RigMotionEstimator::AcquireTrailer(RigMotion& motion) {
    const PerUnit<MatchView> views{
        {analysis_[Unit::kTractor]->match_view(), analysis_[Unit::kTrailer]->match_view()}};
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
        matcher_->Acquire(views, regions, view_pairs_);
        for (const ViewPair& pair : view_pairs_) {
            motion.inter[overlap].push_back(
                {tractor.ToView(pair.tractor_px), trailer.ToView(pair.trailer_px)});
        }
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
