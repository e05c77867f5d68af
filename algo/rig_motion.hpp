#pragma once

#include <memory>
#include <optional>
#include <vector>

#include "algo/articulation.hpp"
#include "algo/overlap_parallax.hpp"
#include "algo/seam_hysteresis.hpp"
#include "algo/task_runner.hpp"
#include "algo/trailer_placement.hpp"
#include "algo/unified_options.hpp"
#include "algo/unit_analysis.hpp"

namespace hitchview::algo {

/// What one frame set tells of the motion within the units and between them.
struct RigMotion {
    PerUnit<IntraMotion> intra;
    PerOverlap<InterFeatures> inter;  ///< px of the views
    PerOverlap<InterFeatures> dense;  ///< likewise, spread evenly: for the stitching field
    Eigen::Matrix3d M_tractor_trailer = Eigen::Matrix3d::Identity();
    bool placed = false;   ///< false: M_tractor_trailer means nothing
    bool matched = false;  ///< false: there are no pairs, the placement is predicted
    PerOverlap<SeamState> seams{{SeamState::kNoOverlap, SeamState::kNoOverlap}};
    PerOverlap<int> matches;
    PerOverlap<int> candidates;
    PerUnit<int> features;
    std::optional<Articulation> articulation;  ///< ring only
};

/// Ring only: pairs of one frame set, as dense as it gets, px of the views. Large.
using RigParallax = PerOverlap<ParallaxSamples>;

/// Where both views are thought to lie on the canvas when features are matched between them.
struct MatchGuess {
    bool match = true;  ///< false: they are not, to save time; the seams' states stay as they were
    Eigen::Matrix3d M_canvas_tractor = Eigen::Matrix3d::Identity();
    /// On the canvas: from where the matched placement puts the trailer to where it is shown.
    Eigen::Matrix3d M_shown_placed = Eigen::Matrix3d::Identity();
    VertexField discrepancy = VertexField::Zero();  ///< left there; see StitchingMotionField
};

/// Frames in, motion out: the estimation that the live and the offline form share. Analyses each
/// unit alone, places the trailer's view on the tractor's and matches features in the overlaps.
class RigMotionEstimator {
 public:
    /// `geometry[kTrailer]` may be empty. The canvas and both views have the same projection.
    RigMotionEstimator(const Projection& canvas,
                       const PerUnit<std::optional<UnitGeometry>>& geometry,
                       const UnifiedVertexMotionOptions& options);
    ~RigMotionEstimator();

    /// Before the first Estimate: looks for the trailer in one frame set, from nothing. True if it
    /// was found or need not be.
    bool Prime(const RigFrames& frames, TaskRunner& runner);
    /// The frame set after the one before. `parallax`: null if nobody asks for it.
    void Estimate(const RigFrames& frames, const MatchGuess& guess, TaskRunner& runner,
                  RigMotion& motion, RigParallax* parallax = nullptr);
    /// Forgets everything that crosses frames; the placement stays.
    void Reset();

    [[nodiscard]] int units() const { return placement_ ? 2 : 1; }
    /// Null as long as the trailer was not found.
    [[nodiscard]] const Eigen::Matrix3d* M_tractor_trailer() const {
        return placement_ && placement_->acquired() ? &placement_->M_tractor_trailer() : nullptr;
    }

 private:
    void Analyse(const RigFrames& frames, TaskRunner& runner, RigMotion& motion);
    void FollowTrailer(const MatchGuess& guess, TaskRunner& runner, RigMotion& motion,
                       RigParallax* parallax);
    void MatchUnits(const MatchGuess& guess, TaskRunner& runner, RigMotion& motion,
                    RigParallax* parallax);
    bool AcquireTrailer(RigMotion& motion);
    [[nodiscard]] PerUnit<cv::Rect> SearchedRegions(Overlap overlap) const;
    [[nodiscard]] bool LongUnmatched() const;
    void Guide(const MatchGuess& guess, TaskRunner& runner, RigMotion& motion,
               RigParallax* parallax);
    void GuideOverlap(const MatchGuess& guess, Overlap overlap, RigMotion& motion);
    void MatchDensely(Overlap overlap, RigMotion& motion, ParallaxSamples* samples);
    [[nodiscard]] PerUnit<MatchView> MatchViews() const;
    [[nodiscard]] InterFeature ToViews(const ViewPair& pair) const;
    void LayLattice();
    void ToViews(const ViewPairs& pairs, InterFeatures& features) const;
    void UpdateSeams(const RigMotion& motion);
    [[nodiscard]] const Projection& view(Unit unit) const {
        return unit == Unit::kTractor ? tractor_view_ : *trailer_view_;
    }

    Projection canvas_;
    Projection tractor_view_;
    std::optional<Projection> trailer_view_;
    bool stitch_;
    PerUnit<std::unique_ptr<UnitAnalysis>> analysis_;
    std::unique_ptr<ClassicalMatcher> matcher_;
    std::unique_ptr<TrailerPlacement> placement_;
    PerOverlap<std::unique_ptr<OverlapParallax>> parallax_;  // ring only
    std::unique_ptr<ArticulationEstimator> articulation_;    // ring only
    PerOverlap<SeamHysteresis> seams_;
    PerOverlap<int> matches_;
    std::int64_t matched_ = 0;  // frame sets
    int searches_ = 0;          // for the trailer
    PerOverlap<ViewPairs> view_pairs_;
    std::vector<Eigen::Vector2f> lattice_;  // plane only: px of the tractor's analysis view
    std::unique_ptr<RigMotion> primed_;
};

}  // namespace hitchview::algo
