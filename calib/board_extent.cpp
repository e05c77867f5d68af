#include "calib/board_extent.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>
#include <optional>

namespace hitchview::calib {
namespace {

using Eigen::Vector2d;

/// How the grey levels on a circle go up and down, once and twice round. Between four squares they
/// go twice; beside the edge of the board once.
struct Harmonics {
    double once = 0;
    double twice = 0;
};

/// Empty where the circle leaves the picture.
std::optional<Harmonics> HarmonicsAround(const cv::Mat& grey, const Vector2d& centre,
                                         double radius_px) {
    constexpr int kPoints = 32;
    Vector2d once = Vector2d::Zero();
    Vector2d twice = Vector2d::Zero();
    for (int i = 0; i < kPoints; ++i) {
        const double turn = 2 * std::numbers::pi * i / kPoints;
        const Vector2d at = centre + radius_px * Vector2d(std::cos(turn), std::sin(turn));
        const auto x = static_cast<int>(std::lround(at.x()));
        const auto y = static_cast<int>(std::lround(at.y()));
        if (x < 0 || y < 0 || x >= grey.cols || y >= grey.rows) return std::nullopt;
        const double level = grey.at<std::uint8_t>(y, x);
        once += level * Vector2d(std::cos(turn), std::sin(turn));
        twice += level * Vector2d(std::cos(2 * turn), std::sin(2 * turn));
    }
    return Harmonics{once.norm() / kPoints, twice.norm() / kPoints};
}

/// One side of the grid: the corners of its last three lines, the outermost first.
struct Side {
    std::array<std::vector<Vector2d>, 3> lines;
};

std::array<Side, 4> Sides(const Board& board, const SeenCorners& corners) {
    const auto at = [&](int column, int row) {
        return corners[static_cast<std::size_t>(row * board.columns + column)].at_px;
    };
    std::array<Side, 4> sides;
    for (int depth = 0; depth < 3; ++depth) {
        const auto line = static_cast<std::size_t>(depth);
        for (int column = 0; column < board.columns; ++column) {
            sides[0].lines.at(line).push_back(at(column, depth));
            sides[1].lines.at(line).push_back(at(column, board.rows - 1 - depth));
        }
        for (int row = 0; row < board.rows; ++row) {
            sides[2].lines.at(line).push_back(at(depth, row));
            sides[3].lines.at(line).push_back(at(board.columns - 1 - depth, row));
        }
    }
    return sides;
}

/// Where the next line's corner would be: lines are bent by the lens and draw together.
Vector2d Next(const Side& side, std::size_t i) {
    return 3 * side.lines[0][i] - 3 * side.lines[1][i] + side.lines[2][i];
}

bool GoesOnAt(const cv::Mat& grey, const Side& side) {
    constexpr double kRadius = 0.3;    // of a square
    constexpr double kAsStrong = 0.5;  // as at the corner beside it
    constexpr double kMostOnce = 0.5;  // of the twice
    constexpr double kMost = 0.8;      // of the places
    int looked_at = 0;
    int crossings = 0;
    for (std::size_t i = 0; i < side.lines[0].size(); ++i) {
        const Vector2d next = Next(side, i);
        const double radius_px = std::max(2.0, kRadius * (next - side.lines[0][i]).norm());
        const auto there = HarmonicsAround(grey, next, radius_px);
        const auto here = HarmonicsAround(grey, side.lines[0][i], radius_px);
        if (!there || !here) continue;
        ++looked_at;
        if (there->twice > kAsStrong * here->twice && there->once < kMostOnce * there->twice)
            ++crossings;
    }
    return looked_at >= 2 && crossings >= kMost * looked_at;
}

}  // namespace

bool GoesOnBeyond(const cv::Mat& grey, const Board& board, const SeenCorners& corners) {
    return std::ranges::any_of(Sides(board, corners),
                               [&](const Side& side) { return GoesOnAt(grey, side); });
}

}  // namespace hitchview::calib
