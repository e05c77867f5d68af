#pragma once

#include <Eigen/Core>
#include <opencv2/core.hpp>
#include <optional>
#include <vector>

#include "calib/board.hpp"

namespace hitchview::calib {

/// The board's inner corners in a grey picture, px to some hundredths, row by row; empty if not all
/// of them are found. Where the board looks the same when turned, as most do, the first corner is
/// the one that makes rows run to the right and columns down in the picture.
std::optional<std::vector<Eigen::Vector2d>> DetectChessboard(const cv::Mat& grey,
                                                             const Board& board);

/// The same in a picture reduced to about 640 px, refined in the whole one: takes some hundredths
/// of a second whether there is a board or not, where the other one takes seconds to be sure that
/// there is none. Misses boards whose squares are smaller than some 8 px of 640.
std::optional<std::vector<Eigen::Vector2d>> DetectChessboardQuickly(const cv::Mat& grey,
                                                                    const Board& board);

/// The ways in which a board of this size can be turned onto itself as far as its grid goes, each
/// as the corner to put in each place; the first changes nothing. Colours of the squares are not
/// looked at.
std::vector<std::vector<int>> GridTurns(const Board& board);

}  // namespace hitchview::calib
