#pragma once

#include <opencv2/core.hpp>
#include <optional>

#include "calib/board.hpp"

namespace hitchview::calib {

/// Standard deviation of the blur across the edges between a board's corners, px: what focus,
/// motion and the lens make of a sharp step. The larger of that across rows and across columns, as
/// a moving board is smeared in one direction. A sharp picture has 0.4 to 0.8. Empty where fewer
/// than four edges can be measured. `grey` is the picture in which the corners were found.
std::optional<double> BoardBlur_px(const cv::Mat& grey, const Board& board,
                                   const SeenCorners& corners);

}  // namespace hitchview::calib
