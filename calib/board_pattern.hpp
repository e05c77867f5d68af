#pragma once

#include <Eigen/Core>
#include <vector>

#include "calib/board.hpp"

namespace hitchview::calib {

/// Upright, in the board frame; m.
struct BoardRectangle {
    Eigen::Vector2d from_m = Eigen::Vector2d::Zero();  ///< top left
    Eigen::Vector2d to_m = Eigen::Vector2d::Zero();    ///< bottom right

    [[nodiscard]] Eigen::Vector2d size_m() const { return to_m - from_m; }
};

/// What is dark on a board: rectangles that may touch and do not overlap. All else is white.
std::vector<BoardRectangle> DarkRectangles(const Board& board);

/// Where the pattern lies, without the white around it.
BoardRectangle PatternArea(const Board& board);

/// White that must be left around the pattern, so that its outermost corners are found.
double WhiteMargin_m(const Board& board);

/// Top left corner of the frame of tag `index`, counted from the board's first; for boards with
/// tags.
Eigen::Vector2d TagOrigin_m(const Board& board, int index);

}  // namespace hitchview::calib
