#include "calib/board_detector.hpp"

#include <algorithm>

#include "calib/chessboard_detector.hpp"
#include "calib/saddle.hpp"
#include "calib/tag_family.hpp"
#include "calib/tag_neighbours.hpp"

namespace hitchview::calib {
namespace {

using Eigen::Vector2d;

SeenCorners DetectCheckerboard(const cv::Mat& grey, const Board& board, Search search) {
    const auto corners = search == Search::kQuick ? DetectChessboardQuickly(grey, board)
                                                  : DetectChessboard(grey, board);
    return corners ? AllCorners(*corners) : SeenCorners{};
}

/// What to expect at a corner of the board; its quarters reach `reach_m`.
ExpectedSaddle Expected(const LocalMap& map, const Vector2d& corner_m, double reach_m) {
    ExpectedSaddle expected{.at_px = map(corner_m)};
    expected.along_px = map(corner_m + Vector2d(reach_m, 0)) - expected.at_px;
    expected.down_px = map(corner_m + Vector2d(0, reach_m)) - expected.at_px;
    return expected;
}

void AddIfSeen(const cv::Mat& grey, const ExpectedSaddle& expected, int index, SeenCorners& seen) {
    if (const auto at_px = FindSaddle(grey, expected)) seen.push_back({index, *at_px});
}

/// The corners of its frame: beyond them stand small squares, inside them its first bits.
SeenCorners DetectTagCorners(const cv::Mat& grey, const Board& board,
                             const std::vector<BoardTag>& tags) {
    const double reach_m = std::min(board.square_m - board.tag_m, board.tag_m / kTagModules);
    SeenCorners seen;
    for (const BoardTag& tag : tags) {
        const auto map = LocalMap::Of(board, {&tag, 1});
        for (int i = 0; map && i < 4; ++i) {
            const int index = 4 * tag.index + i;
            ExpectedSaddle expected = Expected(*map, board.Corner(index).head<2>(), reach_m);
            expected.top_left_dark = i % 2 == 0;
            AddIfSeen(grey, expected, index, seen);
        }
    }
    return seen;
}

/// Those whose white square touches the corner.
std::vector<BoardTag> TagsBeside(const Board& board, const std::vector<BoardTag>& tags,
                                 const Vector2d& corner_m) {
    std::vector<BoardTag> beside;
    for (const BoardTag& tag : tags) {
        const auto corners_m = TagCorners_m(board, tag.index);
        const Vector2d apart_m = (corners_m[0] + corners_m[2]) / 2 - corner_m;
        if (apart_m.lpNorm<Eigen::Infinity>() < 0.75 * board.square_m) beside.push_back(tag);
    }
    return beside;
}

SeenCorners DetectCharuco(const cv::Mat& grey, const Board& board,
                          const std::vector<BoardTag>& tags) {
    const double reach_m = (board.square_m - board.tag_m) / 2;
    SeenCorners seen;
    for (int index = 0; index < board.count(); ++index) {
        const Vector2d corner_m = board.Corner(index).head<2>();
        const auto map = LocalMap::Of(board, TagsBeside(board, tags, corner_m));
        if (!map) continue;
        ExpectedSaddle expected = Expected(*map, corner_m, reach_m);
        expected.top_left_dark = (index / board.columns + index % board.columns) % 2 == 0;
        AddIfSeen(grey, expected, index, seen);
    }
    return seen;
}

/// What `read` finds, if there is a board for it.
std::vector<SeenTag> TagsIn(const cv::Mat& grey, std::span<const Board> boards, Pattern pattern,
                            std::vector<SeenTag> (*read)(const cv::Mat&)) {
    const bool wanted =
        std::ranges::any_of(boards, [&](const Board& board) { return board.pattern == pattern; });
    return wanted ? read(grey) : std::vector<SeenTag>{};
}

}  // namespace

std::vector<SeenCorners> DetectBoards(const cv::Mat& grey, std::span<const Board> boards,
                                      Search search) {
    constexpr int kSmallest_px = 32;  // finding and refining need some room
    if (std::min(grey.cols, grey.rows) < kSmallest_px)
        return std::vector<SeenCorners>(boards.size());
    const auto tags = TagsIn(grey, boards, Pattern::kCharuco, ReadTags);
    const auto joined_tags = TagsIn(grey, boards, Pattern::kTags, ReadJoinedTags);
    std::vector<SeenCorners> seen;
    for (const Board& board : boards) {
        switch (board.pattern) {
            case Pattern::kCheckerboard:
                seen.push_back(DetectCheckerboard(grey, board, search));
                break;
            case Pattern::kCharuco:
                seen.push_back(DetectCharuco(grey, board, TagsOf(board, tags)));
                break;
            case Pattern::kTags:
                seen.push_back(DetectTagCorners(grey, board, TagsOf(board, joined_tags)));
                break;
        }
    }
    return seen;
}

}  // namespace hitchview::calib
