#include "calib/board.hpp"

#include <charconv>
#include <iterator>

namespace hitchview::calib {
namespace {

/// Takes a number off the front of `text`. False: there is none.
template <typename Number>
bool TakeNumber(std::string_view& text, Number& number) {
    const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), number);
    if (error != std::errc{}) return false;
    text.remove_prefix(static_cast<std::size_t>(end - text.data()));
    return true;
}

bool Take(std::string_view& text, char expected) {
    if (!text.starts_with(expected)) return false;
    text.remove_prefix(1);
    return true;
}

bool IsSound(const Board& board) {
    constexpr int kFewest = 3;
    constexpr int kMost = 50;
    return board.columns >= kFewest && board.columns <= kMost && board.rows >= kFewest &&
           board.rows <= kMost && board.square_m >= 0.001 && board.square_m <= 2;
}

}  // namespace

Eigen::Vector3d Board::Corner(int index) const {
    if (pattern != Pattern::kTags)
        return {index % columns * square_m, index / columns * square_m, 0};
    const int tag = index / 4;
    const int corner = index % 4;
    return {tag % columns * square_m + (corner == 1 || corner == 2 ? tag_m : 0),
            tag / columns * square_m + (corner >= 2 ? tag_m : 0), 0};
}

int Board::tags() const {
    switch (pattern) {
        case Pattern::kCheckerboard:
            return 0;
        case Pattern::kCharuco:
            return (columns + 1) * (rows + 1) / 2;
        case Pattern::kTags:
            return columns * rows;
    }
    return 0;
}

std::vector<Eigen::Vector3d> Board::Corners() const {
    std::vector<Eigen::Vector3d> corners;
    for (int i = 0; i < count(); ++i) corners.push_back(Corner(i));
    return corners;
}

SeenCorners AllCorners(const std::vector<Eigen::Vector2d>& at_px) {
    SeenCorners corners;
    for (int i = 0; i < std::ssize(at_px); ++i)
        corners.push_back({i, at_px[static_cast<std::size_t>(i)]});
    return corners;
}

ParsedBoard ParseBoard(std::string_view text) {
    Board board;
    std::string_view rest = text;
    const bool read = TakeNumber(rest, board.columns) && Take(rest, 'x') &&
                      TakeNumber(rest, board.rows) && Take(rest, ',') &&
                      TakeNumber(rest, board.square_m) && rest.empty();
    if (read && IsSound(board)) return {.board = board};
    return {.error = "board is '" + std::string(text) +
                     "', must be COLSxROWS,SQUARE_M: inner corners [3, 50] and metres [0.001, 2], "
                     "as 9x6,0.025"};
}

}  // namespace hitchview::calib
