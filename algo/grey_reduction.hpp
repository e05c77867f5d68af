#pragma once

#include <opencv2/core/mat.hpp>

#include "algo/box_mean.hpp"
#include "algo/camera_frame.hpp"

namespace hitchview::algo {

/// Shrinks pictures by a whole factor. Memory is taken at construction; not thread-safe.
class GreyReduction {
 public:
    /// `side`: samples of each side of the squares that become one pixel: 1, 2, 4 or 8. No row that
    /// is reduced may be longer than `max_width_px` pixels of the result.
    GreyReduction(int side, int max_width_px);

    /// Means of the squares, rounded, for the part `used` of `reduced`. `plane` has a square for
    /// each of its pixels, its samples beside each other or at every second byte.
    void Reduce(const SamplePlane& plane, const cv::Rect& used, cv::Mat1b& reduced);

 private:
    int side_;
    BoxMean means_;
};

}  // namespace hitchview::algo
