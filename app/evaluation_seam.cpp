#include "app/evaluation_seam.hpp"

#include <cmath>
#include <opencv2/calib3d.hpp>
#include <opencv2/imgproc.hpp>

#include "app/evaluation_coverage.hpp"
#include "app/evaluation_statistics.hpp"

namespace hitchview::app {
namespace {

constexpr std::size_t kFewestPairs = 12;

PointPairs OnOneEpipolarGeometry(const PointPairs& pairs) {
    constexpr std::size_t kFewestForFit = 16;
    if (pairs.size() < kFewestForFit) return {};
    std::vector<uchar> kept;
    const cv::Mat fit =
        cv::findFundamentalMat(pairs.first, pairs.second, cv::FM_RANSAC, 1.5, 0.999, kept);
    return fit.empty() ? PointPairs{} : pairs.Keep(kept);
}

// Real parallax stays; what slid along its epipolar line, far from any one plane, goes.
PointPairs NearOnePlane(const PointPairs& pairs) {
    if (pairs.size() < kFewestPairs) return {};
    const cv::Rect2f bounds = cv::boundingRect(pairs.first);
    const double threshold_px = 0.06 * std::hypot(bounds.width, bounds.height);
    std::vector<uchar> kept;
    const cv::Mat fit =
        cv::findHomography(pairs.first, pairs.second, cv::RANSAC, threshold_px, kept);
    return fit.empty() ? PointPairs{} : pairs.Keep(kept);
}

double CentreColumn(const cv::Mat& mask) {
    const cv::Moments moments = cv::moments(mask, true);
    return moments.m00 > 0 ? moments.m10 / moments.m00 : mask.cols / 2.0;
}

cv::Rect Around(const cv::Rect& overlap, cv::Size canvas) {
    constexpr int kMarginPx = 48;
    const cv::Point margin(kMarginPx, kMarginPx);
    const cv::Rect wide(overlap.tl() - margin, overlap.br() + margin);
    return wide & cv::Rect({}, canvas);
}

PointPairs Moved(PointPairs pairs, cv::Point2f by) {
    for (cv::Point2f& point : pairs.first) point += by;
    for (cv::Point2f& point : pairs.second) point += by;
    return pairs;
}

}  // namespace

void SeamMeter::Append(const cv::Mat& tractor_grey, const cv::Mat& trailer_grey,
                       const cv::Mat& overlap, int frame) {
    ++appended_;
    const cv::Rect where = cv::boundingRect(overlap);
    if (where.empty()) return;
    const PointPairs pairs = NearOnePlane(
        OnOneEpipolarGeometry(MatchSift(tractor_grey(where), trailer_grey(where), overlap(where))));
    if (pairs.size() < kFewestPairs) return;
    frames_.push_back(Measure(pairs, frame));
    const SeamFrame& figures = frames_.back();
    if (worst_.tractor_grey.empty() || figures.mean_px > worst_.figures.mean_px) {
        const cv::Rect around = Around(where, overlap.size());
        worst_ = {figures, tractor_grey(around).clone(), trailer_grey(around).clone(),
                  Moved(pairs, where.tl() - around.tl())};
    }
}

SeamFrame SeamMeter::Measure(const PointPairs& pairs, int frame) {
    std::vector<double> distances_px;
    for (std::size_t i = 0; i < pairs.size(); ++i) {
        const cv::Point2d offset = pairs.first[i] - pairs.second[i];
        distances_px.push_back(cv::norm(offset));
        horizontal_px_.push_back(std::abs(offset.x));
        vertical_px_.push_back(std::abs(offset.y));
    }
    distances_px_.insert(distances_px_.end(), distances_px.begin(), distances_px.end());
    return {.frame = frame,
            .pairs = static_cast<int>(pairs.size()),
            .mean_px = Mean(distances_px).value_or(0),
            .p95_px = Quantile(distances_px, 0.95).value_or(0)};
}

SeamScores SeamMeter::Scores() const {
    SeamScores scores{.median_px = Quantile(distances_px_, 0.5),
                      .p95_px = Quantile(distances_px_, 0.95),
                      .worst_frame_px = Largest(Collect(frames_, &SeamFrame::mean_px)),
                      .horizontal_median_px = Quantile(horizontal_px_, 0.5),
                      .horizontal_p95_px = Quantile(horizontal_px_, 0.95),
                      .vertical_median_px = Quantile(vertical_px_, 0.5),
                      .vertical_p95_px = Quantile(vertical_px_, 0.95),
                      .measured_share = {}};
    if (appended_ > 0) {
        scores.measured_share = static_cast<double>(frames_.size()) / appended_;
    }
    return scores;
}

algo::PerOverlap<cv::Mat> OverlapMasks(const cv::Mat& tractor_grey, const cv::Mat& trailer_grey) {
    const cv::Mat tractor = ShownBy(tractor_grey);
    cv::Mat both = tractor & ShownBy(trailer_grey);
    cv::erode(both, both, cv::Mat::ones(11, 11, CV_8U));
    cv::Mat labels;
    cv::Mat statistics;
    cv::Mat centres;
    const int parts = cv::connectedComponentsWithStats(both, labels, statistics, centres);
    const double middle = CentreColumn(tractor);
    algo::PerOverlap<cv::Mat> masks;
    for (cv::Mat& mask : masks.of) mask = cv::Mat::zeros(both.size(), CV_8U);
    for (int part = 1; part < parts; ++part) {  // 0 is the background
        const bool left = centres.at<double>(part, 0) < middle;
        masks[left ? algo::Overlap::kLeft : algo::Overlap::kRight].setTo(255, labels == part);
    }
    return masks;
}

}  // namespace hitchview::app
