#include "app/evaluation_report_pictures.hpp"

#include <algorithm>
#include <opencv2/imgproc.hpp>

#include "app/evaluation_coverage.hpp"
#include "app/html_report.hpp"

namespace hitchview::app {
namespace {

const cv::Scalar kYellow(0, 220, 255);
const cv::Scalar kGreen(90, 230, 90);
constexpr int kFractionBits = 4;

cv::Point Fixed(const cv::Point2f& point) {
    return cv::Point2f(point * static_cast<float>(1 << kFractionBits));
}

void DrawLine(cv::Mat& picture, cv::Point2f a, cv::Point2f b, const cv::Scalar& colour) {
    cv::line(picture, Fixed(a), Fixed(b), colour, 1, cv::LINE_AA, kFractionBits);
}

// Pixels of the page for one of a picture of `size`: two of them fit side by side, a tall one is
// not taller than a screen.
double ShownScale(cv::Size size) {
    constexpr double kWidestPx = 460;
    constexpr double kTallestPx = 620;
    constexpr double kMostEnlarged = 3;
    return std::min({kMostEnlarged, kWidestPx / size.width, kTallestPx / size.height});
}

cv::Mat Scaled(const cv::Mat& picture) {
    cv::Mat scaled;
    const double scale = ShownScale(picture.size());
    cv::resize(picture, scaled, {}, scale, scale, scale < 1 ? cv::INTER_AREA : cv::INTER_CUBIC);
    return scaled;
}

cv::Mat Difference(const cv::Mat& tractor_grey, const cv::Mat& trailer_grey) {
    cv::Mat bgr;
    cv::merge(std::vector<cv::Mat>{trailer_grey, trailer_grey, tractor_grey}, bgr);
    // Where there is one layer only there is nothing to compare: that one, dimmed.
    cv::Mat one;
    cv::cvtColor(cv::max(tractor_grey, trailer_grey) * 0.5, one, cv::COLOR_GRAY2BGR);
    const cv::Mat both = ShownBy(tractor_grey) & ShownBy(trailer_grey);
    bgr.copyTo(one, both);
    return one;
}

constexpr float kVectorsEnlarged = 5;

void DrawVectors(const PointPairs& pairs, double scale, cv::Mat& bgr) {
    constexpr int kRadiusPx = 2;
    const auto s = static_cast<float>(scale);
    for (std::size_t i = 0; i < pairs.size(); ++i) {
        const cv::Point2f from = pairs.first[i] * s;
        const cv::Point2f error = (pairs.second[i] - pairs.first[i]) * s;
        cv::circle(bgr, Fixed(from), kRadiusPx << kFractionBits, kGreen, 1, cv::LINE_AA,
                   kFractionBits);
        DrawLine(bgr, from, from + kVectorsEnlarged * error, kYellow);
    }
}

// Where H puts the lines of a grid of square cells on a picture of `size`.
void DrawGrid(const cv::Matx33d& H_picture_grid, cv::Size size, double scale, cv::Mat& bgr) {
    constexpr int kCells = 8;
    const float cell = static_cast<float>(size.width) / kCells;
    const auto put = [&](float x, float y) {
        std::vector<cv::Point2f> point{{x, y}};
        cv::perspectiveTransform(point, point, H_picture_grid);
        return point[0] * static_cast<float>(scale);
    };
    const auto width = static_cast<float>(size.width);
    const auto height = static_cast<float>(size.height);
    for (float x = 0; x <= width; x += cell) DrawLine(bgr, put(x, 0), put(x, height), kYellow);
    for (float y = 0; y <= height; y += cell) DrawLine(bgr, put(0, y), put(width, y), kYellow);
}

// The part of the canvas where the picture of size `in` went, and a little around it.
cv::Rect Shown(const cv::Matx33d& H_out_in, cv::Size in, cv::Size canvas) {
    constexpr int kMarginPx = 24;
    const cv::Size2f size(in);
    std::vector<cv::Point2f> corners{
        {0, 0}, {size.width, 0}, {size.width, size.height}, {0, size.height}};
    cv::perspectiveTransform(corners, corners, H_out_in);
    const cv::Rect placed = cv::boundingRect(corners);
    const cv::Point margin(kMarginPx, kMarginPx);
    return cv::Rect(placed.tl() - margin, placed.br() + margin) & cv::Rect({}, canvas);
}

cv::Mat WithGrid(const cv::Mat& grey, const cv::Matx33d& H_picture_grid, cv::Size grid) {
    cv::Mat bgr;
    cv::cvtColor(Scaled(grey), bgr, cv::COLOR_GRAY2BGR);
    DrawGrid(H_picture_grid, grid, ShownScale(grey.size()), bgr);
    return bgr;
}

}  // namespace

std::string SeamPictures(const WorstSeam& seam) {
    cv::Mat difference = Scaled(Difference(seam.tractor_grey, seam.trailer_grey));
    DrawVectors(seam.pairs, ShownScale(seam.tractor_grey.size()), difference);
    const std::string frame = "frame " + std::to_string(seam.figures.frame);
    return "<div class=\"pictures\">" +
           Figure(Scaled(seam.tractor_grey), "Tractor's layer, " + frame) +
           Figure(Scaled(seam.trailer_grey), "Trailer's layer, " + frame) +
           Figure(difference,
                  "Difference: red is the tractor's, cyan the trailer's, grey is agreement. Each "
                  "yellow line is a pair's error, enlarged " +
                      Number(kVectorsEnlarged, 0) + " times; " +
                      std::to_string(seam.figures.pairs) + " pairs, mean " +
                      Number(seam.figures.mean_px, 2) + " px, 95 % below " +
                      Number(seam.figures.p95_px, 2) + " px") +
           "</div>";
}

std::string ViewPictures(const WorstView& view) {
    const cv::Size grid = view.in_grey.size();
    const cv::Rect shown = Shown(view.H_out_in, grid, view.out_grey.size());
    const cv::Matx33d H_shown_in =
        cv::Matx33d(1, 0, -shown.x, 0, 1, -shown.y, 0, 0, 1) * view.H_out_in;
    const std::string frame = "frame " + std::to_string(view.figures.frame);
    return "<div class=\"pictures\">" +
           Figure(WithGrid(view.in_grey, cv::Matx33d::eye(), grid),
                  "Camera's picture, " + frame + ", with a square grid") +
           Figure(WithGrid(view.out_grey(shown), H_shown_in, grid),
                  "Stabilised, and where the grid went: distortion " +
                      Number(view.figures.picture.distortion, 4) +
                      " by singular values, cropping " + Number(view.figures.picture.cropping, 4)) +
           "</div>";
}

}  // namespace hitchview::app
