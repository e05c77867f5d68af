#pragma once

#include "algo/camera_frame.hpp"
#include "algo/feature_matcher.hpp"
#include "algo/feature_tracker.hpp"
#include "algo/grey_pyramid.hpp"
#include "algo/semi_surround_view.hpp"
#include "algo/stabilization_motion_field.hpp"

namespace hitchview::algo {

struct UnitAnalysisOptions {
    double scale = 1;  ///< analysis size / view size, (0, 1]
    FeatureTrackerOptions tracker{};
    StabilizationMotionFieldOptions field{};
};

/// The steps that concern one unit alone: semi-surround view, intra features, stabilization motion
/// field. Keeps the early view with its pyramid and the features.
class UnitAnalysis {
 public:
    UnitAnalysis(const UnitGeometry& geometry, const UnitAnalysisOptions& options);

    /// Takes the unit's frames of one moment; the frames of the call before are the early ones.
    void Analyse(const UnitFrames& frames, IntraMotion& motion);
    void Reset();

    /// What the matcher needs of the moment analysed last.
    [[nodiscard]] MatchView match_view() const {
        return {&late_, &view_.mask(), tracker_.features()};
    }
    [[nodiscard]] const SemiSurroundView& view() const { return view_; }
    [[nodiscard]] int features() const { return static_cast<int>(intra_features_.size()); }

 private:
    void FindSights();

    UnitGeometry geometry_;
    SemiSurroundView view_;
    GreyPyramid early_;
    GreyPyramid late_;
    FeatureTracker tracker_;
    StabilizationMotionField field_;
    FeatureTracker::Tracks tracks_;
    FeatureMotions intra_features_;
    FixedVector<SightMotion, kMaxFeatures> sights_;
};

}  // namespace hitchview::algo
