#pragma once

#include <cstdint>
#include <opencv2/core/mat.hpp>
#include <vector>

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
    std::vector<std::uint16_t> sums_;  // of the columns of a row of squares
    std::vector<std::uint16_t> pairs_;
};

}  // namespace hitchview::algo
