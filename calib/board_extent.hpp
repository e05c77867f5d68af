#pragma once

#include <Eigen/Core>
#include <opencv2/core.hpp>
#include <vector>

#include "calib/board.hpp"

namespace hitchview::calib {

/// Whether the chessboard in the picture goes on beyond the corners that were found, on any side
/// that lies in the picture: then it has more inner corners than was said, and what was found may
/// be another part of it in every picture. `corners`: row by row.
bool GoesOnBeyond(const cv::Mat& grey, const Board& board, const SeenCorners& corners);

}  // namespace hitchview::calib
