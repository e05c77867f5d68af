#pragma once

#include <opencv2/core.hpp>
#include <optional>
#include <vector>

#include "algo/unit.hpp"
#include "app/evaluation_features.hpp"

namespace hitchview::app {

/// Misalignment in one overlap, px of the canvas; empty when no frame could be measured.
struct SeamScores {
    std::optional<double> median_px;
    std::optional<double> p95_px;
    /// Largest mean of a frame: the stitching score of Guo et al. 2016.
    std::optional<double> worst_frame_px;
    std::optional<double> horizontal_median_px;
    std::optional<double> horizontal_p95_px;
    std::optional<double> vertical_median_px;
    std::optional<double> vertical_p95_px;
    std::optional<double> measured_share;  ///< of the frames: those with 12 pairs or more
};

/// One frame that could be measured.
struct SeamFrame {
    int frame = 0;
    int pairs = 0;
    double mean_px = 0;
    double p95_px = 0;
};

/// The frame of the largest mean: the part of the canvas around the overlap, and its pairs there.
struct WorstSeam {
    SeamFrame figures;
    cv::Mat tractor_grey;  ///< empty: no frame could be measured
    cv::Mat trailer_grey;
    PointPairs pairs;  ///< first: in the tractor's picture, second: in the trailer's
};

/// Distances, on the canvas, of points that show the same thing in both warped layers. The pairs
/// are found anew in the finished layers (mutual SIFT matches), and nothing is fitted to them that
/// could make a distance smaller: none of them took part in the alignment, so all are held out.
/// Mismatches are dropped by what no alignment could mend: pairs that disagree with one fundamental
/// matrix (1.5 px), or that lie farther from every plane than 6 % of the overlap's diagonal. Frames
/// with fewer than 12 pairs are left out of every distance.
class SeamMeter {
 public:
    /// Both layers on one canvas, before blending. `overlap`: where both show something.
    void Append(const cv::Mat& tractor_grey, const cv::Mat& trailer_grey, const cv::Mat& overlap,
                int frame);

    [[nodiscard]] SeamScores Scores() const;
    [[nodiscard]] const std::vector<SeamFrame>& frames() const { return frames_; }
    [[nodiscard]] const WorstSeam& worst() const { return worst_; }

 private:
    SeamFrame Measure(const PointPairs& pairs, int frame);

    std::vector<double> distances_px_;
    std::vector<double> horizontal_px_;
    std::vector<double> vertical_px_;
    std::vector<SeamFrame> frames_;
    WorstSeam worst_;
    int appended_ = 0;
};

/// Where both layers (grey, pure black where there is no data) show something, 5 px off every
/// border. Each connected part belongs to the side of the tractor layer's centre that its own
/// centre is on.
algo::PerOverlap<cv::Mat> OverlapMasks(const cv::Mat& tractor_grey, const cv::Mat& trailer_grey);

}  // namespace hitchview::app
