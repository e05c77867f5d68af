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
    std::optional<double> kept_mean;             ///< of the input picture, inside the canvas
    std::optional<double> kept_min;              ///< worst frame
    int frames_failed = 0;                       ///< without a homography; not in the figures
};

/// One frame that could be measured.
struct ViewFrame {
    int frame = 0;
    double cropping = 0;
    double distortion = 0;
    double distortion_eigen = 0;
    double kept = 0;
};

/// The frame of the smallest distortion figure, with both pictures.
struct WorstView {
    ViewFrame figures;
    cv::Mat in_grey;  ///< empty: no frame could be measured
    cv::Mat out_grey;
    cv::Matx33d H_out_in;
};

/// Fits the homography from each input frame to its output frame (RANSAC, 2 px, on 50 tracks or
/// more) and looks at its upper left 2 x 2 part A, with H(2,2) = 1.
///   cropping           min(1, 1 / sqrt|det A|): one pixel of either picture is one pixel, so the
///                      size of the canvas does not matter
///   distortion         smaller over larger singular value of A: any stretch or shear, in any
///                      direction
///   distortion_eigen   smaller over larger eigenvalue of A by absolute value, 1 for a complex
///   pair:
///                      the literature's form; blind to a stretch under a rotation
///   kept               share of the input picture that H leaves inside the canvas
/// Mean and smallest value over frames are the literature's cropping ratio and global distortion
/// (Liu et al. 2013, section 6).
class ViewMeter {
 public:
    void Append(const cv::Mat& in_grey, const cv::Mat& out_grey, int frame);

    [[nodiscard]] ViewScores Scores() const;
    [[nodiscard]] const std::vector<ViewFrame>& frames() const { return frames_; }
    [[nodiscard]] const WorstView& worst() const { return worst_; }

 private:
    std::vector<ViewFrame> frames_;
    WorstView worst_;
    int failed_ = 0;
};

}  // namespace hitchview::app
