#include "app/evaluation_coverage.hpp"

#include <algorithm>
#include <opencv2/imgproc.hpp>

namespace hitchview::app {
namespace {

cv::Mat WithoutHoles(const cv::Mat& mask) {
    std::vector<std::vector<cv::Point>> outlines;
    cv::findContours(mask, outlines, cv::RETR_EXTERNAL, cv::CHAIN_APPROX_NONE);
    cv::Mat filled = cv::Mat::zeros(mask.size(), CV_8U);
    cv::drawContours(filled, outlines, -1, 255, cv::FILLED);
    return filled;
}

// Largest rectangle that stands on the base line of columns of these heights. The stack holds
// columns of rising height; one is closed by the first lower column to its right.
double LargestRectangleBelow(const std::vector<int>& heights) {
    double largest = 0;
    std::vector<std::size_t> open;
    for (std::size_t x = 0; x <= heights.size(); ++x) {
        const int height = x < heights.size() ? heights[x] : 0;
        while (!open.empty() && heights[open.back()] >= height) {
            const double closed_height = heights[open.back()];
            open.pop_back();
            const std::size_t left = open.empty() ? 0 : open.back() + 1;
            largest = std::max(largest, closed_height * static_cast<double>(x - left));
        }
        open.push_back(x);
    }
    return largest;
}

}  // namespace

// Compression leaves a little noise in the black that surrounds a layer: hence 16, and closing.
cv::Mat ShownBy(const cv::Mat& layer_grey) {
    constexpr double kBlack = 16;
    cv::Mat shown = layer_grey > kBlack;
    cv::morphologyEx(shown, shown, cv::MORPH_CLOSE, cv::Mat::ones(11, 11, CV_8U));
    return shown;
}

void CoverageMeter::Append(const cv::Mat& panorama_grey, int frame) {
    const cv::Mat shown = WithoutHoles(ShownBy(panorama_grey));
    const double share =
        static_cast<double>(cv::countNonZero(shown)) / static_cast<double>(shown.total());
    frames_.push_back({frame, share});
    common_ = common_.empty() ? shown : cv::Mat(common_ & shown);
}

std::optional<double> CoverageMeter::CommonRectangleShare() const {
    if (common_.empty()) return std::nullopt;
    return LargestRectangleArea(common_) / static_cast<double>(common_.total());
}

double LargestRectangleArea(const cv::Mat& mask) {
    CV_Assert(mask.type() == CV_8U);
    double largest = 0;
    std::vector<int> heights(static_cast<std::size_t>(mask.cols), 0);
    for (int y = 0; y < mask.rows; ++y) {
        for (int x = 0; x < mask.cols; ++x) {
            int& height = heights[static_cast<std::size_t>(x)];
            height = mask.at<uchar>(y, x) != 0 ? height + 1 : 0;
        }
        largest = std::max(largest, LargestRectangleBelow(heights));
    }
    return largest;
}

}  // namespace hitchview::app
