#include "calib/board_pattern.hpp"

#include "calib/tag_family.hpp"

namespace hitchview::calib {
namespace {

using Eigen::Vector2d;
using Rectangles = std::vector<BoardRectangle>;

void AddSquare(const Vector2d& from_m, double side_m, Rectangles& dark) {
    dark.push_back({from_m, from_m + Vector2d::Constant(side_m)});
}

/// Dark modules that lie side by side become one rectangle.
void AddTag(const Vector2d& from_m, double side_m, int number, Rectangles& dark) {
    const TagModules modules = DarkModules(number);
    const double module_m = side_m / kTagModules;
    for (int row = 0; row < kTagModules; ++row) {
        const auto is_dark = [&](int column) {
            return column < kTagModules &&
                   modules[static_cast<std::size_t>(row * kTagModules + column)];
        };
        for (int first = 0, end = 0; first < kTagModules; first = end + 1) {
            for (end = first; is_dark(end);) ++end;
            if (end == first) continue;
            dark.push_back({from_m + module_m * Vector2d(first, row),
                            from_m + module_m * Vector2d(end, row + 1)});
        }
    }
}

void AddTags(const Board& board, Rectangles& dark) {
    for (int i = 0; i < board.tags(); ++i)
        AddTag(TagOrigin_m(board, i), board.tag_m, board.first_tag + i, dark);
}

void AddSquares(const Board& board, Rectangles& dark) {
    for (int row = 0; row <= board.rows; ++row) {
        for (int column = row % 2; column <= board.columns; column += 2)
            AddSquare(board.square_m * Vector2d(column - 1, row - 1), board.square_m, dark);
    }
}

/// Each fills the gap between the corners of four tags: what stands there are two dark and two
/// white quarters, as between the squares of a checkerboard.
void AddGapSquares(const Board& board, Rectangles& dark) {
    const double gap_m = board.square_m - board.tag_m;
    for (int row = 0; row <= board.rows; ++row) {
        for (int column = 0; column <= board.columns; ++column)
            AddSquare(board.square_m * Vector2d(column, row) - Vector2d::Constant(gap_m), gap_m,
                      dark);
    }
}

}  // namespace

std::vector<BoardRectangle> DarkRectangles(const Board& board) {
    Rectangles dark;
    if (board.pattern == Pattern::kTags) {
        AddGapSquares(board, dark);
    } else {
        AddSquares(board, dark);
    }
    AddTags(board, dark);
    return dark;
}

BoardRectangle PatternArea(const Board& board) {
    const double before_m =
        board.pattern == Pattern::kTags ? board.square_m - board.tag_m : board.square_m;
    return {Vector2d::Constant(-before_m), board.square_m * Vector2d(board.columns, board.rows)};
}

double WhiteMargin_m(const Board& board) {
    switch (board.pattern) {
        case Pattern::kCheckerboard:
            return board.square_m;
        case Pattern::kCharuco:
            return board.square_m / 2;
        case Pattern::kTags:
            return board.square_m - board.tag_m;
    }
    return 0;
}

Vector2d TagOrigin_m(const Board& board, int index) {
    if (board.pattern == Pattern::kTags)
        return board.square_m * Vector2d(index % board.columns, index / board.columns);
    // White squares are every other one; two rows together have as many as a row has squares.
    const int squares = board.columns + 1;
    const int pair = index / squares;
    const int in_upper = squares / 2;
    const int in_pair = index % squares;
    const bool upper = in_pair < in_upper;
    const int row = 2 * pair + (upper ? 0 : 1);
    const int column = upper ? 2 * in_pair + 1 : 2 * (in_pair - in_upper);
    return board.square_m * Vector2d(column - 1, row - 1) +
           Vector2d::Constant((board.square_m - board.tag_m) / 2);
}

}  // namespace hitchview::calib
