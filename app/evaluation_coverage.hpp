#pragma once

#include <opencv2/core.hpp>
#include <optional>
#include <vector>

namespace hitchview::app {

/// Where a layer (grey, pure black where there is no data) shows something: 255, else 0. Noise of
/// compression in the black does not count; dark spots up to 11 px inside the picture do.
cv::Mat ShownBy(const cv::Mat& layer_grey);

struct CoverageFrame {
    int frame = 0;
    double share = 0;  ///< of the canvas that shows something
};

/// How much of a fixed canvas a panorama fills. A dark area inside the picture counts as picture,
/// so that night does not look like a missing camera.
class CoverageMeter {
 public:
    /// `panorama_grey`: all of one size.
    void Append(const cv::Mat& panorama_grey, int frame);

    [[nodiscard]] const std::vector<CoverageFrame>& frames() const { return frames_; }
    /// Area of the largest upright rectangle that every frame fills, over that of the canvas: what
    /// is left for somebody who cuts the black borders off once and for all. Empty for no frames.
    [[nodiscard]] std::optional<double> CommonRectangleShare() const;

 private:
    std::vector<CoverageFrame> frames_;
    cv::Mat common_;
};

/// Area, px, of the largest upright rectangle without a 0 in `mask` (CV_8U).
double LargestRectangleArea(const cv::Mat& mask);

}  // namespace hitchview::app
