#pragma once

#include <opencv2/core/mat.hpp>

#include "algo/corner_detector.hpp"
#include "algo/feature_motion.hpp"
#include "algo/grey_pyramid.hpp"
#include "algo/patch_alignment.hpp"

namespace hitchview::algo {

struct FeatureTrackerOptions {
    int features = 300;              ///< kept alive; at most kMaxFeatures
    int coarsest_level = 3;          ///< pyramid level where the search starts
    float max_round_trip_px = 0.5F;  ///< forward-backward check
    float min_correlation = 0.60F;
    float blurred_share = 0.35F;  ///< fewer features found than this: motion has blurred detail
    int blurred_level = 2;        ///< pyramid level that is trusted then; finer ones are not
    CornerDetectorOptions corners{};
    PatchAlignmentOptions alignment{};
};

/// Intra motion: follows corners from one frame of a view to the next. State: the features of the
/// early frame. Positions are pixels of the analysis view.
class FeatureTracker {
 public:
    struct Track {
        Eigen::Vector2f early_px;
        Eigen::Vector2f late_px;
    };
    using Tracks = FixedVector<Track, kMaxFeatures>;

    FeatureTracker(int width_px, int height_px, const FeatureTrackerOptions& options);

    /// Replaces `tracks` by the features of `early` found in `late`: aligned from coarse to fine,
    /// then aligned back at full size from where they started, and kept if they return there. Where
    /// motion has blurred one of the frames, that is done at a coarse level alone. Then
    /// fills up with new corners of `late` where `mask` is not zero. The first call after Reset
    /// gives no tracks.
    void Follow(const GreyPyramid& early, const GreyPyramid& late, const cv::Mat1b& mask,
                Tracks& tracks);

    void Reset() { features_.clear(); }

    /// Features of the late frame of the last call.
    [[nodiscard]] std::span<const Eigen::Vector2f> features() const {
        return {features_.data(), features_.size()};
    }

 private:
    void FollowFeatures(const GreyPyramid& early, const GreyPyramid& late, const cv::Mat1b& mask,
                        int finest_level, Tracks& tracks) const;
    void Replenish(const cv::Mat1b& late, const cv::Mat1b& mask);

    FeatureTrackerOptions options_;
    CornerDetector detector_;
    CornerDetector::Corners corners_;
    FixedVector<Eigen::Vector2f, kMaxFeatures> features_;
};

}  // namespace hitchview::algo
