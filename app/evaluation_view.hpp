#pragma once

#include <opencv2/core.hpp>
#include <optional>
#include <vector>

namespace hitchview::app {

/// What stabilisation did to one unit's picture. Figures are empty when no frame could be measured.
struct ViewScores {
    std::optional<double> cropping_mean;         ///< 1: nothing is enlarged
    std::optional<double> cropping_min;          ///< worst frame
    std::optional<double> distortion_min;        ///< worst frame; 1: no anisotropy
    std::optional<double> distortion_p01;        ///< 1st percentile of the frames
    std::optional<double> distortion_eigen_min;  ///< from eigenvalues, as the literature has it
    int frames_measured = 0;
    int frames_failed = 0;  ///< without a homography; not in the figures
};

/// Fits the homography from each input frame to its output frame and looks at its upper left 2 x 2
/// part A, with H(2,2) = 1. Cropping is min(1, 1 / sqrt|det A|): one pixel of either picture is one
/// pixel, so the size of the canvas does not matter. Distortion is the ratio of A's singular
/// values.
class ViewMeter {
 public:
    void Append(const cv::Mat& in_grey, const cv::Mat& out_grey);
    [[nodiscard]] ViewScores Scores() const;

 private:
    std::vector<double> cropping_;
    std::vector<double> distortion_;
    std::vector<double> distortion_eigen_;
    int failed_ = 0;
};

}  // namespace hitchview::app
