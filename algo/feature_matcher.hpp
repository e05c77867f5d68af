#pragma once

#include <opencv2/core/mat.hpp>
#include <span>

#include "algo/corner_detector.hpp"
#include "algo/feature_motion.hpp"
#include "algo/grey_pyramid.hpp"
#include "algo/patch_alignment.hpp"
#include "algo/patch_descriptor.hpp"
#include "algo/unit.hpp"

namespace hitchview::algo {

/// What a matcher sees of one unit: the analysis view at one moment.
struct MatchView {
    const GreyPyramid* pyramid;
    const cv::Mat1b* mask;                      ///< non-zero where features may lie
    std::span<const Eigen::Vector2f> features;  ///< tracked corners
};

/// The same scene point in both analysis views, pixels.
struct ViewPair {
    Eigen::Vector2f tractor_px;
    Eigen::Vector2f trailer_px;
};
using ViewPairs = FixedVector<ViewPair, kMaxInterFeatures>;

/// Where a pixel of one analysis view is expected in the other one.
class Expectation {
 public:
    virtual ~Expectation() = default;
    /// False if `pixel` of `unit` lies outside the overlap in question.
    virtual bool Expect(Unit unit, const Eigen::Vector2f& pixel, Eigen::Vector2f& other) const = 0;
};

/// Finds inter features: correspondences between the two units' views (paper eq. of section
/// 'Inter Motion Initialization', where it is LoFTR). A learned matcher can take this one's place:
/// it is fed the views and gives pairs; outliers are allowed, the robust fits come after it.
class FeatureMatcher {
 public:
    virtual ~FeatureMatcher() = default;

    /// Guided: looks for every tracked feature of both views near where `expectation` puts it.
    void Guide(const PerUnit<MatchView>& views, const Expectation& expectation, ViewPairs& pairs) {
        DoGuide(views, expectation, pairs);
    }
    /// Unguided: from nothing, between the parts of the two views that `regions` allow.
    void Acquire(const PerUnit<MatchView>& views, const PerUnit<cv::Rect>& regions,
                 ViewPairs& pairs) {
        DoAcquire(views, regions, pairs);
    }

 private:
    virtual void DoGuide(const PerUnit<MatchView>& views, const Expectation& expectation,
                         ViewPairs& pairs) = 0;
    virtual void DoAcquire(const PerUnit<MatchView>& views, const PerUnit<cv::Rect>& regions,
                           ViewPairs& pairs) = 0;
};

struct ClassicalMatcherOptions {
    int guided_level = 2;  ///< pyramid level where the guided search starts
    float min_correlation = 0.70F;
    float max_round_trip_px = 0.7F;
    int corners_per_level = 400;  ///< described when acquiring
    int descriptor_levels = 3;
    float max_distance_ratio = 0.85F;  ///< best descriptor distance / second best
    int max_distance = 90;             ///< of 256 bits
    CornerDetectorOptions corners{};
    PatchAlignmentOptions alignment{};
};

/// Patch alignment around the expected place; binary descriptors to acquire.
class ClassicalMatcher final : public FeatureMatcher {
 public:
    ClassicalMatcher(int width_px, int height_px, const ClassicalMatcherOptions& options);

 private:
    struct Described {
        Eigen::Vector2f position_px;  // of level 0
        PatchDescriptor descriptor;
    };
    static constexpr std::size_t kMaxDescribed = 1200;
    using DescribedCorners = FixedVector<Described, kMaxDescribed>;

    void DoGuide(const PerUnit<MatchView>& views, const Expectation& expectation,
                 ViewPairs& pairs) override;
    void DoAcquire(const PerUnit<MatchView>& views, const PerUnit<cv::Rect>& regions,
                   ViewPairs& pairs) override;

    void GuideFrom(Unit unit, const PerUnit<MatchView>& views, const Expectation& expectation,
                   ViewPairs& pairs) const;
    bool Align(const PerUnit<MatchView>& views, Unit from, const Eigen::Vector2f& at,
               const Eigen::Vector2f& guess, int coarsest, ViewPair& pair) const;
    const cv::Mat1b& AllowedAt(int level, const cv::Mat1b& mask, const cv::Rect& region);
    void Describe(const MatchView& view, const cv::Rect& region, DescribedCorners& described);

    ClassicalMatcherOptions options_;
    std::array<CornerDetector, GreyPyramid::kMaxLevels> detectors_;
    CornerDetector::Corners corners_;
    PerUnit<DescribedCorners> described_;
    std::array<cv::Mat1b, GreyPyramid::kMaxLevels> allowed_;  // of the levels, as detectors_
};

}  // namespace hitchview::algo
