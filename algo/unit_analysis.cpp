#include "algo/unit_analysis.hpp"

namespace hitchview::algo {

UnitAnalysis::UnitAnalysis(const UnitGeometry& geometry, const UnitAnalysisOptions& options)
    : view_(geometry, options.scale),
      early_(view_.width_px(), view_.height_px()),
      late_(view_.width_px(), view_.height_px()),
      tracker_(view_.width_px(), view_.height_px(), options.tracker),
      field_(geometry.view(), options.field) {}

void UnitAnalysis::Analyse(const UnitFrames& frames, IntraMotion& motion) {
    swap(early_, late_);
    view_.Compose(frames, late_.base());
    late_.Build();
    tracker_.Follow(early_, late_, view_.mask(), tracks_);
    intra_features_.clear();
    for (const FeatureTracker::Track& track : tracks_) {
        intra_features_.push_back({view_.ToView(track.early_px), view_.ToView(track.late_px)});
    }
    field_.Estimate(intra_features_, motion);
}

void UnitAnalysis::Reset() {
    tracker_.Reset();
}

}  // namespace hitchview::algo
