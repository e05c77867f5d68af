#pragma once

#include <opencv2/core.hpp>
#include <optional>
#include <vector>

#include "algo/unit.hpp"

namespace hitchview::app {

/// Misalignment in one overlap, px of the canvas; empty when no frame could be measured.
struct SeamScores {
    std::optional<double> median_px;
    std::optional<double> p95_px;
    std::optional<double> worst_frame_px;  ///< largest mean of a frame (Guo et al. 2016)
    std::optional<double> horizontal_median_px;
    std::optional<double> vertical_median_px;
    std::optional<double> measured_share;  ///< of the frames: those with 12 pairs or more
};

/// Distances, on the canvas, of points that show the same thing in both warped layers. The pairs
/// are found anew (mutual SIFT matches that agree with one fundamental matrix), so that none of
/// them took part in the alignment. Frames with fewer than 12 pairs are left out of every distance.
class SeamMeter {
 public:
    /// Both layers on one canvas, before blending. `overlap`: where both show something.
    void Append(const cv::Mat& tractor_grey, const cv::Mat& trailer_grey, const cv::Mat& overlap);
    [[nodiscard]] SeamScores Scores() const;

 private:
    std::vector<double> distances_px_;
    std::vector<double> horizontal_px_;
    std::vector<double> vertical_px_;
    std::vector<double> frame_means_px_;
    int frames_ = 0;
};

/// Where both layers (grey, pure black where there is no data) show something, 5 px off every
/// border. Each connected part belongs to the side of the tractor layer's centre that its own
/// centre is on.
algo::PerOverlap<cv::Mat> OverlapMasks(const cv::Mat& tractor_grey, const cv::Mat& trailer_grey);

}  // namespace hitchview::app
