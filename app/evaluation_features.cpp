#include "app/evaluation_features.hpp"

#include <cmath>
#include <map>
#include <opencv2/calib3d.hpp>
#include <opencv2/features2d.hpp>
#include <opencv2/imgproc.hpp>
#include <opencv2/video/tracking.hpp>

namespace hitchview::app {
namespace {

constexpr std::size_t kFewestPairs = 10;

std::vector<cv::Point2f> Corners(const cv::Mat& grey, const cv::Mat& mask) {
    std::vector<cv::Point2f> corners;
    cv::goodFeaturesToTrack(grey, corners, 250, 0.01, 8, mask, 5);
    return corners;
}

struct Tracks {
    std::vector<cv::Point2f> points;
    std::vector<uchar> found;
};

Tracks Track(const cv::Mat& from, const cv::Mat& to, const std::vector<cv::Point2f>& points) {
    const cv::TermCriteria criteria(cv::TermCriteria::COUNT | cv::TermCriteria::EPS, 15, 0.03);
    Tracks tracks;
    std::vector<float> error;
    cv::calcOpticalFlowPyrLK(from, to, points, tracks.points, tracks.found, error, {15, 15}, 4,
                             criteria);
    return tracks;
}

struct Sift {
    std::vector<cv::KeyPoint> points;
    cv::Mat descriptors;

    Sift(const cv::Mat& grey, const cv::Mat& mask) {
        cv::SIFT::create(1500)->detectAndCompute(grey, mask, points, descriptors);
    }
};

// Chosen feature of `to` for each feature of `from`.
std::map<int, int> Choose(const Sift& from, const Sift& to) {
    std::vector<std::vector<cv::DMatch>> candidates;
    cv::BFMatcher(cv::NORM_L2).knnMatch(from.descriptors, to.descriptors, candidates, 2);
    std::map<int, int> chosen;
    for (const std::vector<cv::DMatch>& best : candidates) {
        if (best.size() == 2 && best[0].distance < 0.75F * best[1].distance) {
            chosen[best[0].queryIdx] = best[0].trainIdx;
        }
    }
    return chosen;
}

}  // namespace

PointPairs PointPairs::Keep(const std::vector<uchar>& kept) const {
    PointPairs result;
    for (std::size_t i = 0; i < size(); ++i) {
        if (kept[i] == 0) continue;
        result.first.push_back(first[i]);
        result.second.push_back(second[i]);
    }
    return result;
}

PointPairs TrackCorners(const cv::Mat& first, const cv::Mat& second, const cv::Mat& mask) {
    constexpr double kLongestRoundTripPx = 0.5;
    PointPairs pairs{.first = Corners(first, mask), .second = {}};
    if (pairs.size() < 8) return {};
    const Tracks there = Track(first, second, pairs.first);
    const Tracks back = Track(second, first, there.points);
    pairs.second = there.points;
    std::vector<uchar> kept(pairs.size());
    for (std::size_t i = 0; i < kept.size(); ++i) {
        const double round_trip_px = cv::norm(pairs.first[i] - back.points[i]);
        kept[i] = there.found[i] != 0 && back.found[i] != 0 && round_trip_px < kLongestRoundTripPx;
    }
    return pairs.Keep(kept);
}

PointPairs MatchSift(const cv::Mat& first, const cv::Mat& second, const cv::Mat& mask) {
    const Sift a(first, mask);
    const Sift b(second, mask);
    PointPairs pairs;
    if (a.points.size() < 8 || b.points.size() < 8) return pairs;
    const std::map<int, int> to_a = Choose(b, a);
    for (const auto& [i, j] : Choose(a, b)) {
        const auto returned = to_a.find(j);
        if (returned == to_a.end() || returned->second != i) continue;
        pairs.first.push_back(a.points[static_cast<std::size_t>(i)].pt);
        pairs.second.push_back(b.points[static_cast<std::size_t>(j)].pt);
    }
    return pairs;
}

PointPairs MatchOrb(const cv::Mat& first, const cv::Mat& second) {
    const cv::Ptr<cv::ORB> orb =
        cv::ORB::create(900, 1.2F, 8, 31, 0, 2, cv::ORB::HARRIS_SCORE, 31, 8);
    std::vector<cv::KeyPoint> a;
    std::vector<cv::KeyPoint> b;
    cv::Mat a_descriptors;
    cv::Mat b_descriptors;
    orb->detectAndCompute(first, {}, a, a_descriptors);
    orb->detectAndCompute(second, {}, b, b_descriptors);
    PointPairs pairs;
    if (a.size() <= kFewestPairs || b.size() <= kFewestPairs) return pairs;
    std::vector<cv::DMatch> matches;
    cv::BFMatcher(cv::NORM_HAMMING, true).match(a_descriptors, b_descriptors, matches);
    for (const cv::DMatch& match : matches) {
        pairs.first.push_back(a[static_cast<std::size_t>(match.queryIdx)].pt);
        pairs.second.push_back(b[static_cast<std::size_t>(match.trainIdx)].pt);
    }
    return pairs;
}

std::optional<cv::Matx33d> FitHomography(const PointPairs& pairs, double threshold_px) {
    if (pairs.size() < kFewestPairs) return std::nullopt;
    cv::Mat inliers;
    const cv::Mat fit = cv::findHomography(pairs.first, pairs.second, cv::RANSAC, threshold_px,
                                           inliers, 3000, 0.999);
    if (fit.empty() || cv::countNonZero(inliers) < static_cast<int>(kFewestPairs)) {
        return std::nullopt;
    }
    const cv::Matx33d H = cv::Matx33d(fit) * (1 / fit.at<double>(2, 2));
    const double area_scale = H(0, 0) * H(1, 1) - H(0, 1) * H(1, 0);
    return std::abs(area_scale) < 1e-3 ? std::nullopt : std::optional(H);
}

}  // namespace hitchview::app
