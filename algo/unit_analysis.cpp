#include "algo/unit_analysis.hpp"

namespace hitchview::algo {

UnitAnalysis::UnitAnalysis(const UnitGeometry& geometry, const UnitAnalysisOptions& options)
    : geometry_(geometry),
      view_(geometry, options.scale),
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
    FindSights();
    field_.Estimate(intra_features_, {sights_.data(), sights_.size()}, motion);
}

/// Intra features as their cameras see them; those that pass from one camera to another are no
/// motion of either.
void UnitAnalysis::FindSights() {
    sights_.clear();
    const Projection& picture = geometry_.view();
    if (!picture.IsRing()) return;
    for (const FeatureTracker::Track& track : tracks_) {
        const auto camera = view_.CameraAt(track.early_px);
        if (!camera || view_.CameraAt(track.late_px) != camera) continue;
        const SightLine early =
            geometry_.SightOf(*camera, picture.Ray(view_.ToView(track.early_px)));
        const SightLine late = geometry_.SightOf(*camera, picture.Ray(view_.ToView(track.late_px)));
        sights_.push_back({early.direction, late.direction, early.origin_m});
    }
}

void UnitAnalysis::Reset() {
    tracker_.Reset();
    field_.Reset();
}

}  // namespace hitchview::algo
