#include "calib/chessboard_detector.hpp"

#include <algorithm>
#include <cmath>
#include <opencv2/calib3d.hpp>
#include <opencv2/imgproc.hpp>

namespace hitchview::calib {
namespace {

using Eigen::Vector2d;
using Points = std::vector<cv::Point2f>;

bool FindByContours(const cv::Mat& grey, const Board& board, Points& corners) {
    return cv::findChessboardCorners(grey, {board.columns, board.rows}, corners,
                                     cv::CALIB_CB_ADAPTIVE_THRESH | cv::CALIB_CB_NORMALIZE_IMAGE);
}

/// Finds small, tilted and unevenly lit boards that the other one misses, and takes longer.
bool FindBySectors(const cv::Mat& grey, const Board& board, Points& corners) {
    return cv::findChessboardCornersSB(
        grey, {board.columns, board.rows}, corners,
        cv::CALIB_CB_NORMALIZE_IMAGE | cv::CALIB_CB_EXHAUSTIVE | cv::CALIB_CB_ACCURACY);
}

float Distance(const cv::Point2f& a, const cv::Point2f& b) {
    return std::hypot(a.x - b.x, a.y - b.y);
}

/// To the nearest corner of the same row or column.
float Spacing(const Points& corners, const Board& board) {
    float least = 1e9F;
    for (int i = 0; i < board.count(); ++i) {
        const auto at = [&](int index) { return corners[static_cast<std::size_t>(index)]; };
        if (i % board.columns + 1 < board.columns)
            least = std::min(least, Distance(at(i), at(i + 1)));
        if (i + board.columns < board.count())
            least = std::min(least, Distance(at(i), at(i + board.columns)));
    }
    return least;
}

/// The window must not reach into the next square: its edges would draw the corner to them.
void Refine(const cv::Mat& grey, const Board& board, Points& corners) {
    const int half = std::clamp(static_cast<int>(0.3F * Spacing(corners, board)), 2, 8);
    cv::cornerSubPix(grey, corners, {half, half}, {-1, -1},
                     {cv::TermCriteria::EPS | cv::TermCriteria::COUNT, 60, 1e-4});
}

/// How far rows run to the right and columns down.
double Uprightness(const Points& corners, const Board& board, const std::vector<int>& turn) {
    const auto at = [&](int index) {
        return corners[static_cast<std::size_t>(turn[static_cast<std::size_t>(index)])];
    };
    const int last = board.count() - 1;
    const int row_end = board.columns - 1;
    const int column_end = board.count() - board.columns;
    const cv::Point2f along = at(row_end) + at(last) - at(0) - at(column_end);
    const cv::Point2f down = at(column_end) + at(last) - at(0) - at(row_end);
    return along.x + down.y - std::abs(along.y) - std::abs(down.x);
}

/// The same grid with rows running backwards: no turn, but what a detector may give.
std::vector<int> Mirrored(const Board& board, const std::vector<int>& turn) {
    std::vector<int> mirrored;
    for (int i = 0; i < board.count(); ++i) {
        const int row = i / board.columns;
        const int column = board.columns - 1 - i % board.columns;
        mirrored.push_back(turn[static_cast<std::size_t>(row * board.columns + column)]);
    }
    return mirrored;
}

std::vector<Vector2d> Upright(const Points& corners, const Board& board) {
    std::vector<std::vector<int>> orders = GridTurns(board);
    for (std::size_t i = 0, turns = orders.size(); i < turns; ++i)
        orders.push_back(Mirrored(board, orders[i]));
    const auto best = std::ranges::max_element(
        orders, {}, [&](const auto& order) { return Uprightness(corners, board, order); });
    std::vector<Vector2d> upright;
    for (const int index : *best) {
        const cv::Point2f& corner = corners[static_cast<std::size_t>(index)];
        upright.emplace_back(corner.x, corner.y);
    }
    return upright;
}

}  // namespace

std::vector<std::vector<int>> GridTurns(const Board& board) {
    const int count = board.count();
    std::vector<std::vector<int>> turns(2);
    for (int i = 0; i < count; ++i) {
        turns[0].push_back(i);
        turns[1].push_back(count - 1 - i);
    }
    if (board.columns != board.rows) return turns;
    const int side = board.columns;
    std::vector<int> quarter;
    for (int i = 0; i < count; ++i) quarter.push_back(i % side * side + side - 1 - i / side);
    turns.push_back(quarter);
    turns.emplace_back(quarter.rbegin(), quarter.rend());
    return turns;
}

std::optional<std::vector<Vector2d>> DetectChessboardQuickly(const cv::Mat& grey,
                                                             const Board& board) {
    constexpr int kWidth_px = 640;
    const int step = std::max(1, grey.cols / kWidth_px);
    cv::Mat reduced = grey;
    if (step > 1)
        cv::resize(grey, reduced, {grey.cols / step, grey.rows / step}, 0, 0, cv::INTER_AREA);
    Points corners;
    if (!cv::findChessboardCornersSB(reduced, {board.columns, board.rows}, corners,
                                     cv::CALIB_CB_NORMALIZE_IMAGE))
        return std::nullopt;
    const float scale_x = static_cast<float>(grey.cols) / static_cast<float>(reduced.cols);
    const float scale_y = static_cast<float>(grey.rows) / static_cast<float>(reduced.rows);
    for (cv::Point2f& corner : corners)
        corner = {(corner.x + 0.5F) * scale_x - 0.5F, (corner.y + 0.5F) * scale_y - 0.5F};
    Refine(grey, board, corners);
    return Upright(corners, board);
}

std::optional<std::vector<Vector2d>> DetectChessboard(const cv::Mat& grey, const Board& board) {
    Points corners;
    if (!FindByContours(grey, board, corners) && !FindBySectors(grey, board, corners))
        return std::nullopt;
    Refine(grey, board, corners);
    return Upright(corners, board);
}

}  // namespace hitchview::calib
