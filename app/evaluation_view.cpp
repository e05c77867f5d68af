#include "app/evaluation_view.hpp"

#include <algorithm>
#include <cmath>
#include <opencv2/imgproc.hpp>

#include "app/evaluation_features.hpp"
#include "app/evaluation_statistics.hpp"

namespace hitchview::app {
namespace {

std::optional<cv::Matx33d> CoarseHomography(const cv::Mat& in, const cv::Mat& out) {
    constexpr double kThresholdPx = 3;
    const auto maybe_H = FitHomography(MatchOrb(in, out), kThresholdPx);
    return maybe_H ? maybe_H : FitHomography(MatchSift(in, out), kThresholdPx);
}

// Tracks the input, warped by the coarse fit, into the output: sub-pixel, and on 50 points or more.
std::optional<cv::Matx33d> HomographyBetween(const cv::Mat& in, const cv::Mat& out) {
    constexpr std::size_t kFewestTracks = 50;
    constexpr double kThresholdPx = 2;
    const auto maybe_coarse = CoarseHomography(in, out);
    if (!maybe_coarse) return std::nullopt;
    cv::Mat warped;
    cv::Mat inside;
    cv::warpPerspective(in, warped, *maybe_coarse, out.size());
    cv::warpPerspective(cv::Mat(in.size(), CV_8U, cv::Scalar(255)), inside, *maybe_coarse,
                        out.size());
    cv::erode(inside, inside, cv::Mat::ones(15, 15, CV_8U));
    PointPairs tracks = TrackCorners(warped, out, inside);
    if (tracks.size() < kFewestTracks) return std::nullopt;
    cv::perspectiveTransform(tracks.first, tracks.first, maybe_coarse->inv());
    return FitHomography(tracks, kThresholdPx);
}

// Smaller over larger eigenvalue by absolute value; 1 for a complex pair.
double EigenRatio(const cv::Matx22d& A) {
    const double half_trace = cv::trace(A) / 2;
    const double discriminant = half_trace * half_trace - cv::determinant(A);
    if (discriminant <= 0) return 1;
    const double a = std::abs(half_trace + std::sqrt(discriminant));
    const double b = std::abs(half_trace - std::sqrt(discriminant));
    return std::min(a, b) / std::max(a, b);
}

double SingularRatio(const cv::Matx22d& A) {
    cv::Matx21d singular;
    cv::SVD::compute(A, singular, cv::SVD::NO_UV);
    return singular(1) / singular(0);
}

}  // namespace

void ViewMeter::Append(const cv::Mat& in_grey, const cv::Mat& out_grey) {
    const auto maybe_H = HomographyBetween(in_grey, out_grey);
    if (!maybe_H) {
        ++failed_;
        return;
    }
    const cv::Matx22d A = maybe_H->get_minor<2, 2>(0, 0);
    cropping_.push_back(std::min(1.0, 1 / std::sqrt(std::abs(cv::determinant(A)))));
    distortion_.push_back(SingularRatio(A));
    distortion_eigen_.push_back(EigenRatio(A));
}

ViewScores ViewMeter::Scores() const {
    return {.cropping_mean = Mean(cropping_),
            .cropping_min = Quantile(cropping_, 0),
            .distortion_min = Quantile(distortion_, 0),
            .distortion_p01 = Quantile(distortion_, 0.01),
            .distortion_eigen_min = Quantile(distortion_eigen_, 0),
            .frames_measured = static_cast<int>(cropping_.size()),
            .frames_failed = failed_};
}

}  // namespace hitchview::app
