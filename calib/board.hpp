#pragma once

#include <Eigen/Core>
#include <filesystem>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

namespace hitchview::calib {

/// What is printed on a board.
enum class Pattern {
    kCheckerboard,  ///< corners between squares; the whole board must be seen
    /// The same with a tag in the middle of each white square: tells its corners apart, so a part
    /// will do. The top left square is black.
    kCharuco,
    /// Tags in a grid, with a small square between the corners of four: a part will do, also far
    /// away or aslant. Like kalibr's aprilgrid, but its frames are two modules wide.
    kTags,
};

/// A flat sheet as it was meant to be printed. Its tags are of the family tag36h11. Board frame:
/// origin in the first corner, x along its row, y along its column, z away from who looks at it.
struct Board {
    int columns = 0;      ///< inner corners in a row, or tags. [3, 50], tags [1, 20]
    int rows = 0;         ///< inner corners in a column, or tags. [3, 50], tags [1, 20]
    double square_m = 0;  ///< side of a square; from tag to tag. [0.001, 2]
    Pattern pattern = Pattern::kCheckerboard;
    double tag_m = 0;   ///< side of a tag's black frame, less than square_m; 0 without tags
    int first_tag = 0;  ///< number of the first tag; the others follow row by row

    /// Corners that can be seen.
    [[nodiscard]] int count() const { return columns * rows * (pattern == Pattern::kTags ? 4 : 1); }
    /// Corner `index`, counted row by row. Those of tags: tag by tag, in each from its top left
    /// clockwise.
    [[nodiscard]] Eigen::Vector3d Corner(int index) const;
    [[nodiscard]] std::vector<Eigen::Vector3d> Corners() const;
    /// Tags on it: `first_tag` and so many more.
    [[nodiscard]] int tags() const;

    friend bool operator==(const Board&, const Board&) = default;
};

/// A board, or what is wrong with its description.
struct ParsedBoard {
    std::optional<Board> board{};
    std::string error{};
};

/// `COLSxROWS,SQUARE_M`: a checkerboard by its inner corners and the side of a square in metres, as
/// 9x6,0.025.
ParsedBoard ParseBoard(std::string_view text);

/// A file that describes a board; strict. The error has one line
/// `file:line: key is VALUE, must be ...` for each mistake. Throws nothing.
ParsedBoard LoadBoard(const std::filesystem::path& file);
/// The same of a file's content. `name`: what complaints call the file.
ParsedBoard ParseBoardFile(const std::string& text, const std::string& name);

/// Writes such a file, in one step: a reader sees the old or the new content, whole. Empty on
/// success, otherwise what went wrong. Throws nothing.
std::string SaveBoard(const Board& board, const std::filesystem::path& file);

/// What people say about a board: as ParseBoard takes it, or the name of a board file.
ParsedBoard ReadBoard(const std::string& text);

/// In words, as `charuco, 9x6 inner corners, squares of 40 mm, tags of 28 mm from number 0`.
std::string Describe(const Board& board);

std::string_view ToString(Pattern pattern);

/// A corner of a board in a picture.
struct SeenCorner {
    int index = 0;  ///< of Board::Corner
    Eigen::Vector2d at_px = Eigen::Vector2d::Zero();

    friend bool operator==(const SeenCorner&, const SeenCorner&) = default;
};

/// Those of one board in one picture, by rising index.
using SeenCorners = std::vector<SeenCorner>;

/// Those of a board that is seen as a whole. `at_px`: one for each corner, in their order.
SeenCorners AllCorners(const std::vector<Eigen::Vector2d>& at_px);

/// One picture of a board.
struct BoardView {
    std::string name{};  ///< of the picture
    SeenCorners corners{};
    std::optional<double> blur_px{};  ///< see BoardBlur_px
};

}  // namespace hitchview::calib
