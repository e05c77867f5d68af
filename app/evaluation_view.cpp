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

std::vector<cv::Point2f> Corners(cv::Size size) {
    const cv::Size2f s(size);
    return {{0, 0}, {s.width, 0}, {s.width, s.height}, {0, s.height}};
}

double KeptShare(const cv::Matx33d& H_out_in, cv::Size in, cv::Size out) {
    std::vector<cv::Point2f> placed;
    std::vector<cv::Point2f> inside;
    cv::perspectiveTransform(Corners(in), placed, H_out_in);
    if (cv::intersectConvexConvex(placed, Corners(out), inside) <= 0) return 0;
    cv::perspectiveTransform(inside, inside, H_out_in.inv());
    return std::min(1.0, cv::contourArea(inside) / in.area());
}

ViewFrame Figures(const cv::Matx33d& H_out_in, cv::Size in, cv::Size out, int frame) {
    const cv::Matx22d A = H_out_in.get_minor<2, 2>(0, 0);
    return {.frame = frame,
            .cropping = std::min(1.0, 1 / std::sqrt(std::abs(cv::determinant(A)))),
            .distortion = SingularRatio(A),
            .distortion_eigen = EigenRatio(A),
            .kept = KeptShare(H_out_in, in, out)};
}

}  // namespace

void ViewMeter::Append(const cv::Mat& in_grey, const cv::Mat& out_grey, int frame) {
    const auto maybe_H = HomographyBetween(in_grey, out_grey);
    if (!maybe_H) {
        ++failed_;
        return;
    }
    frames_.push_back(Figures(*maybe_H, in_grey.size(), out_grey.size(), frame));
    const ViewFrame& figures = frames_.back();
    if (worst_.in_grey.empty() || figures.distortion < worst_.figures.distortion) {
        worst_ = {figures, in_grey.clone(), out_grey.clone(), *maybe_H};
    }
}

ViewScores ViewMeter::Scores() const {
    const auto all = [&](double ViewFrame::*figure) { return Collect(frames_, figure); };
    return {.cropping_mean = Mean(all(&ViewFrame::cropping)),
            .cropping_min = Quantile(all(&ViewFrame::cropping), 0),
            .distortion_min = Quantile(all(&ViewFrame::distortion), 0),
            .distortion_p01 = Quantile(all(&ViewFrame::distortion), 0.01),
            .distortion_eigen_min = Quantile(all(&ViewFrame::distortion_eigen), 0),
            .kept_mean = Mean(all(&ViewFrame::kept)),
            .kept_min = Quantile(all(&ViewFrame::kept), 0),
            .frames_failed = failed_};
}

}  // namespace hitchview::app
