#pragma once

#include <opencv2/core.hpp>
#include <optional>
#include <vector>

namespace hitchview::app {

/// Points that show the same thing in two pictures, px.
struct PointPairs {
    std::vector<cv::Point2f> first;
    std::vector<cv::Point2f> second;

    [[nodiscard]] std::size_t size() const { return first.size(); }
    [[nodiscard]] PointPairs Keep(const std::vector<uchar>& kept) const;
};

/// Corners tracked from one grey picture to another and back; a round trip of 0.5 px or more drops
/// them. `mask`: where corners are sought; empty: everywhere.
PointPairs TrackCorners(const cv::Mat& first, const cv::Mat& second, const cv::Mat& mask = {});

/// SIFT features that choose each other, each clearly ahead of its second choice (ratio 0.75).
PointPairs MatchSift(const cv::Mat& first, const cv::Mat& second, const cv::Mat& mask = {});

/// ORB features that choose each other.
PointPairs MatchOrb(const cv::Mat& first, const cv::Mat& second);

/// RANSAC, with OpenCV's fixed seed. Empty with fewer than 10 inliers, or when the plane collapses.
std::optional<cv::Matx33d> FitHomography(const PointPairs& pairs, double threshold_px);

}  // namespace hitchview::app
