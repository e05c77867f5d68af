#include "algo/feature_tracker.hpp"

#include <algorithm>

#include "algo/feature_mask.hpp"

namespace hitchview::algo {

using Eigen::Vector2f;

FeatureTracker::FeatureTracker(int width_px, int height_px, const FeatureTrackerOptions& options)
    : options_(options), detector_(width_px, height_px, options.corners) {}

void FeatureTracker::Follow(const GreyPyramid& early, const GreyPyramid& late,
                            const cv::Mat1b& mask, Tracks& tracks) {
    FollowFeatures(early, late, mask, 0, tracks);
    const auto found = static_cast<float>(tracks.count());
    if (found < options_.blurred_share * static_cast<float>(features_.count())) {
        FollowFeatures(early, late, mask, std::min(options_.blurred_level, late.levels() - 1),
                       tracks);
    }
    features_.clear();
    for (const Track& track : tracks) features_.push_back(track.late_px);
    Replenish(late.level(0), mask);
}

void FeatureTracker::FollowFeatures(const GreyPyramid& early, const GreyPyramid& late,
                                    const cv::Mat1b& mask, int finest_level, Tracks& tracks) const {
    tracks.clear();
    PatchAlignmentOptions alignment = options_.alignment;
    alignment.finest_level = finest_level;
    const float max_round_trip_px =
        options_.max_round_trip_px * static_cast<float>(1 << finest_level);
    for (const Vector2f& from : features_) {
        const auto there = AlignPatch(early, late, from, from,
                                      std::max(options_.coarsest_level, finest_level), alignment);
        if (!there || there->correlation < options_.min_correlation ||
            !Allows(mask, there->position_px)) {
            continue;
        }
        const auto back =
            AlignPatch(late, early, there->position_px, from, finest_level, alignment);
        if (!back || (back->position_px - from).norm() > max_round_trip_px) continue;
        tracks.push_back({from, there->position_px});
    }
}

void FeatureTracker::Replenish(const cv::Mat1b& late, const cv::Mat1b& mask) {
    const int wanted = std::min<int>(options_.features, kMaxFeatures) - features_.count();
    // A few lost features are not worth a search of the whole picture.
    if (wanted * 10 < options_.features) return;
    detector_.Detect(late, mask, {features_.data(), features_.size()}, wanted, corners_);
    for (const Corner& corner : corners_) features_.push_back(corner.position_px);
}

}  // namespace hitchview::algo
