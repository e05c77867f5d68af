#pragma once

#include <Eigen/Core>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

namespace hitchview::calib {

/// A chessboard as it was meant to be printed. Board frame: origin in the first inner corner, x
/// along its row, y along its column, z away from who looks at it.
struct Board {
    int columns = 0;      ///< inner corners in a row. [3, 50]
    int rows = 0;         ///< inner corners in a column. [3, 50]
    double square_m = 0;  ///< side of a square. [0.001, 2]

    [[nodiscard]] int count() const { return columns * rows; }
    /// Corner `index`, counted row by row.
    [[nodiscard]] Eigen::Vector3d Corner(int index) const {
        return {index % columns * square_m, index / columns * square_m, 0};
    }
    [[nodiscard]] std::vector<Eigen::Vector3d> Corners() const;
};

/// A board, or what is wrong with its description.
struct ParsedBoard {
    std::optional<Board> board{};
    std::string error{};
};

/// `COLSxROWS,SQUARE_M`: inner corners, and the side of a square in metres, as 9x6,0.025.
ParsedBoard ParseBoard(std::string_view text);

/// One picture of a board.
struct BoardView {
    std::string name{};                      ///< of the picture
    std::vector<Eigen::Vector2d> corners{};  ///< px, row by row; as many as the board has
};

}  // namespace hitchview::calib
