#pragma once

#include <Eigen/Core>
#include <optional>
#include <span>
#include <vector>

#include "calib/board.hpp"
#include "calib/tag_reader.hpp"

namespace hitchview::calib {

/// One of a board's tags in a picture, by its place on the board.
struct BoardTag {
    int index = 0;  ///< from the board's first tag
    SeenTag seen;
};

/// Those of `tags` that belong to `board` and agree with their neighbours about where it is, by
/// rising index; none if so many disagree that it must be another board.
std::vector<BoardTag> TagsOf(const Board& board, std::span<const SeenTag> tags);

/// Of the frame of tag `index`, from its top left clockwise, in the board frame.
std::array<Eigen::Vector2d, 4> TagCorners_m(const Board& board, int index);

/// How the board lies in the picture near some tags, where a lens is as good as without distortion.
class LocalMap {
 public:
    /// From at least one tag. Empty: degenerate.
    static std::optional<LocalMap> Of(const Board& board, std::span<const BoardTag> tags);

    /// Picture, px, of a point of the board.
    [[nodiscard]] Eigen::Vector2d operator()(const Eigen::Vector2d& on_board_m) const;

 private:
    explicit LocalMap(const Eigen::Matrix3d& H_picture_board) : H_picture_board_(H_picture_board) {}

    Eigen::Matrix3d H_picture_board_;
};

}  // namespace hitchview::calib
