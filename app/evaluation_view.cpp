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

// Tracks the input, warped by the coarse fit, into the output: sub-pixel. None without such a fit.
PointPairs TracksBetween(const cv::Mat& in, const cv::Mat& out) {
    const auto maybe_coarse = CoarseHomography(in, out);
    if (!maybe_coarse) return {};
    cv::Mat warped;
    cv::Mat inside;
    cv::warpPerspective(in, warped, *maybe_coarse, out.size());
    cv::warpPerspective(cv::Mat(in.size(), CV_8U, cv::Scalar(255)), inside, *maybe_coarse,
                        out.size());
    cv::erode(inside, inside, cv::Mat::ones(15, 15, CV_8U));
    PointPairs tracks = TrackCorners(warped, out, inside);
    if (tracks.size() == 0) return {};
    cv::perspectiveTransform(tracks.first, tracks.first, maybe_coarse->inv());
    return tracks;
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

WarpFigures Figures(const cv::Matx33d& H_out_in) {
    const cv::Matx22d A = H_out_in.get_minor<2, 2>(0, 0);
    return {.cropping = std::min(1.0, 1 / std::sqrt(std::abs(cv::determinant(A)))),
            .distortion = SingularRatio(A),
            .distortion_eigen = EigenRatio(A)};
}

}  // namespace

void ViewMeter::Append(const cv::Mat& in_grey, const cv::Mat& out_grey, int frame) {
    constexpr std::size_t kFewestTracks = 50;
    constexpr double kPlanePx = 2;
    constexpr double kPicturePx = 5;
    const PointPairs tracks = TracksBetween(in_grey, out_grey);
    const auto maybe_H_plane = FitHomography(tracks, kPlanePx);
    const auto maybe_H_picture = FitHomography(tracks, kPicturePx);
    if (tracks.size() < kFewestTracks || !maybe_H_plane || !maybe_H_picture) {
        ++failed_;
        return;
    }
    frames_.push_back({.frame = frame,
                       .plane = Figures(*maybe_H_plane),
                       .picture = Figures(*maybe_H_picture),
                       .kept = KeptShare(*maybe_H_picture, in_grey.size(), out_grey.size())});
    const ViewFrame& figures = frames_.back();
    if (worst_.in_grey.empty() || figures.picture.distortion < worst_.figures.picture.distortion) {
        worst_ = {figures, in_grey.clone(), out_grey.clone(), *maybe_H_picture};
    }
}

ViewScores ViewMeter::Scores() const {
    const auto plane = [&](double WarpFigures::*figure) {
        return Collect(Collect(frames_, &ViewFrame::plane), figure);
    };
    const auto picture = [&](double WarpFigures::*figure) {
        return Collect(Collect(frames_, &ViewFrame::picture), figure);
    };
    const std::vector<double> kept = Collect(frames_, &ViewFrame::kept);
    return {.cropping_mean = Mean(plane(&WarpFigures::cropping)),
            .cropping_min = Quantile(plane(&WarpFigures::cropping), 0),
            .distortion_min = Quantile(plane(&WarpFigures::distortion), 0),
            .distortion_p01 = Quantile(plane(&WarpFigures::distortion), 0.01),
            .distortion_eigen_min = Quantile(plane(&WarpFigures::distortion_eigen), 0),
            .picture_cropping_mean = Mean(picture(&WarpFigures::cropping)),
            .picture_distortion_eigen_min = Quantile(picture(&WarpFigures::distortion_eigen), 0),
            .kept_mean = Mean(kept),
            .kept_min = Quantile(kept, 0),
            .frames_failed = failed_};
}

}  // namespace hitchview::app
