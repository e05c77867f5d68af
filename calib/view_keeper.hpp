#pragma once

#include <Eigen/Core>
#include <array>
#include <string>
#include <vector>

#include "calib/board.hpp"
#include "calib/view_look.hpp"

namespace hitchview::calib {

/// What a set of views must have to be enough for a lens.
struct ViewGoals {
    int views = 20;
    double covered = 0.75;  ///< share of the cells
    int tilted = 3;         ///< to each of the four sides
    int near = 5;           ///< the board's size is at least `near_size` of the picture
    int far = 3;            ///< at most `far_size`
    double near_size = 0.45;
    double far_size = 0.35;
    double most_blur_px = 2.0;
    double most_motion_px = 2.0;  ///< between neighbouring frames, of 1280 px across; 0: any
};

/// Chooses from a camera's pictures of a board those from which its lens can be measured: all over
/// the picture, tilted to all sides, near and far, sharp and still. Without knowing the lens. Pure:
/// the same looks give the same answers. Thread: any, one at a time.
class ViewKeeper {
 public:
    static constexpr int kColumns = 8;
    static constexpr int kRows = 5;

    ViewKeeper(const Board& board, const Eigen::Vector2d& picture_px, const ViewGoals& goals);

    struct Answer {
        bool keep = false;
        std::string advice{};  ///< what to do next, in plain words
    };
    /// The next picture, by its corners and their look (empty: none). What is kept counts.
    Answer Judge(const SeenCorners& corners, const std::optional<CornerLook>& look);

    [[nodiscard]] bool enough() const { return missing().empty(); }
    /// What is not reached yet, one line each.
    [[nodiscard]] std::vector<std::string> missing() const;
    [[nodiscard]] int views() const { return static_cast<int>(kept_.size()); }
    [[nodiscard]] double covered() const;
    /// Views that have corners in each cell, row by row.
    [[nodiscard]] const std::array<int, kColumns * kRows>& cells() const { return cells_; }
    [[nodiscard]] int tilted(Tilt tilt) const { return tilts_[static_cast<std::size_t>(tilt)]; }
    [[nodiscard]] int near() const { return near_; }
    [[nodiscard]] int far() const { return far_; }

 private:
    struct View {
        SeenCorners corners;
        BoardPose pose;
    };

    [[nodiscard]] std::size_t CellOf(const Eigen::Vector2d& at_px) const;
    [[nodiscard]] std::string Flaw(const CornerLook& look) const;
    [[nodiscard]] bool Moves(const SeenCorners& corners) const;
    [[nodiscard]] bool IsNew(const View& view) const;
    [[nodiscard]] bool AddsSomething(const View& view) const;
    [[nodiscard]] std::string NextPlace() const;
    [[nodiscard]] std::string NextNeed() const;
    void Keep(const View& view);

    Board board_;
    Eigen::Vector2d picture_px_;
    ViewGoals goals_;
    SeenCorners last_;
    std::vector<View> kept_;
    std::array<int, kColumns * kRows> cells_{};
    std::array<int, kTilts> tilts_{};
    int near_ = 0;
    int far_ = 0;
};

}  // namespace hitchview::calib
