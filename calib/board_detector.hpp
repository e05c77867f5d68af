#pragma once

#include <opencv2/core.hpp>
#include <span>
#include <vector>

#include "calib/board.hpp"

namespace hitchview::calib {

/// How long checkerboards are looked for.
enum class Search {
    kThorough,
    kQuick,  ///< in live pictures; see DetectChessboardQuickly
};

/// The corners of each board in a grey picture (8 bit, at least 32 px a side), px, to some
/// hundredths of a pixel in sharp pictures; empty for a board that is not seen. Of a checkerboard
/// all corners or none; of boards with tags those beside a tag that could be read, through any
/// lens. Boards in one picture need tags of their own. Thread-safe.
std::vector<SeenCorners> DetectBoards(const cv::Mat& grey, std::span<const Board> boards,
                                      Search search = Search::kThorough);

}  // namespace hitchview::calib
