#pragma once

#include <opencv2/core.hpp>
#include <optional>
#include <vector>

namespace hitchview::app {

/// What one homography does to a picture; all in (0, 1], 1 is best.
struct WarpFigures {
    double cropping = 1;
    double distortion = 1;
    double distortion_eigen = 1;
};

/// One frame that could be measured.
struct ViewFrame {
    int frame = 0;
    WarpFigures plane;    ///< of the homography of the dominant plane
    WarpFigures picture;  ///< of the homography of the whole picture
    double kept = 0;
};

/// What stabilisation did to one unit's picture. Figures are empty when no frame could be measured.
struct ViewScores {
    std::optional<double> cropping_mean;         ///< 1: nothing is enlarged
    std::optional<double> cropping_min;          ///< worst frame
    std::optional<double> distortion_min;        ///< worst frame; 1: no anisotropy
    std::optional<double> distortion_p01;        ///< 1st percentile of the frames
    std::optional<double> distortion_eigen_min;  ///< from eigenvalues, as the literature has it
    std::optional<double> picture_cropping_mean;
    std::optional<double> picture_distortion_eigen_min;
    std::optional<double> kept_mean;  ///< of the input picture, inside the canvas
    std::optional<double> kept_min;   ///< worst frame
    int frames_failed = 0;            ///< without a homography; not in the figures
};

/// The frame whose whole picture is distorted most, with both pictures.
struct WorstView {
    ViewFrame figures;
    cv::Mat in_grey;  ///< empty: no frame could be measured
    cv::Mat out_grey;
    cv::Matx33d H_out_in;  ///< of the whole picture
};

/// Fits homographies from each input frame to its output frame, on 50 tracks or more, and looks at
/// the upper left 2 x 2 part A, with H(2,2) = 1.
///   cropping           min(1, 1 / sqrt|det A|): one pixel of either picture is one pixel, so the
///                      size of the canvas does not matter
///   distortion         smaller over larger singular value of A: any stretch or shear, in any
///                      direction
///   distortion_eigen   smaller over larger eigenvalue of A by absolute value, 1 for a complex
///   pair:
///                      the literature's form; blind to a stretch under a rotation
///   kept               share of the input picture that the homography leaves inside the canvas
/// Two fits to the same tracks: `plane` (RANSAC, 2 px) follows the plane with most tracks,
/// `picture` (5 px, what the literature's evaluations use) nearly all of them. With parallax,
/// neighbouring frames choose different planes: the figures of `plane` then jump by some per cent
/// where nothing jumps on the screen, and their worst frame is the fit's.
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
