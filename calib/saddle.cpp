#include "calib/saddle.hpp"

#include <algorithm>
#include <opencv2/imgproc.hpp>

namespace hitchview::calib {
namespace {

using Eigen::Vector2d;

bool IsInside(const cv::Mat& grey, const Vector2d& at_px) {
    constexpr double kBorder_px = 2;
    return at_px.x() >= kBorder_px && at_px.y() >= kBorder_px &&
           at_px.x() <= grey.cols - 1 - kBorder_px && at_px.y() <= grey.rows - 1 - kBorder_px;
}

/// Between pixels, bilinear; outside the picture that of its edge.
double Sample(const cv::Mat& grey, const Vector2d& at_px) {
    const double at_x = std::clamp(at_px.x(), 0.0, grey.cols - 1.0);
    const double at_y = std::clamp(at_px.y(), 0.0, grey.rows - 1.0);
    const int x = std::min(static_cast<int>(at_x), grey.cols - 2);
    const int y = std::min(static_cast<int>(at_y), grey.rows - 2);
    const double u = at_x - x;
    const double v = at_y - y;
    const std::uint8_t* upper = grey.ptr(y) + x;
    const std::uint8_t* lower = grey.ptr(y + 1) + x;
    return (1 - v) * ((1 - u) * upper[0] + u * upper[1]) + v * ((1 - u) * lower[0] + u * lower[1]);
}

/// Whether the middles of the four quarters are dark and white as they should be.
bool LooksAsExpected(const cv::Mat& grey, const ExpectedSaddle& expected, const Vector2d& at_px) {
    constexpr double kReach = 0.6;    // of the quarters
    constexpr double kContrast = 10;  // grey levels
    const Vector2d falling = kReach * (expected.along_px + expected.down_px);
    const Vector2d rising = kReach * (expected.along_px - expected.down_px);
    const Vector2d& dark = expected.top_left_dark ? falling : rising;
    const Vector2d& white = expected.top_left_dark ? rising : falling;
    return std::min(Sample(grey, at_px + white), Sample(grey, at_px - white)) - kContrast >
           std::max(Sample(grey, at_px + dark), Sample(grey, at_px - dark));
}

Vector2d Refined(const cv::Mat& grey, const Vector2d& start_px, int half_px) {
    std::vector<cv::Point2f> point{
        {static_cast<float>(start_px.x()), static_cast<float>(start_px.y())}};
    cv::cornerSubPix(grey, point, {half_px, half_px}, {-1, -1},
                     {cv::TermCriteria::EPS | cv::TermCriteria::COUNT, 60, 1e-4});
    return {point[0].x, point[0].y};
}

}  // namespace

std::optional<Vector2d> FindSaddle(const cv::Mat& grey, const ExpectedSaddle& expected) {
    constexpr double kLeastReach_px = 1.5;
    constexpr double kMostOff_px = 0.7;
    constexpr int kLeastHalf_px = 2;
    constexpr int kMostHalf_px = 8;
    if (!IsInside(grey, expected.at_px)) return std::nullopt;
    const double reach_px = std::min(expected.along_px.norm(), expected.down_px.norm());
    if (!(reach_px >= kLeastReach_px)) return std::nullopt;
    const int half_px = std::clamp(static_cast<int>(0.8 * reach_px), kLeastHalf_px, kMostHalf_px);
    const Vector2d at_px = Refined(grey, expected.at_px, half_px);
    if (!IsInside(grey, at_px) || (at_px - expected.at_px).norm() > kMostOff_px + 0.3 * reach_px)
        return std::nullopt;
    if (!LooksAsExpected(grey, expected, at_px)) return std::nullopt;
    return at_px;
}

}  // namespace hitchview::calib
