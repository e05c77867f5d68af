#include "calib/board_blur.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <map>
#include <vector>

#include "calib/median.hpp"

namespace hitchview::calib {
namespace {

using Eigen::Vector2d;

enum class Across { kRows, kColumns };

/// Two corners that an edge runs between, and how far the levels beside it reach, as a share of
/// their distance.
struct Edge {
    int from = 0;
    int to = 0;
    double reach = 0;
    Across across = Across::kRows;
};

std::vector<Edge> SquareEdges(const Board& board) {
    constexpr double kInSquare = 0.4;
    constexpr double kInRim = 0.4;  // between the tag in a square and its edge
    double reach = kInSquare;
    if (board.pattern == Pattern::kCharuco)
        reach = kInRim * (board.square_m - board.tag_m) / board.square_m;
    std::vector<Edge> edges;
    for (int i = 0; i < board.count(); ++i) {
        if ((i + 1) % board.columns != 0) edges.push_back({i, i + 1, reach, Across::kRows});
        if (i + board.columns < board.count())
            edges.push_back({i, i + board.columns, reach, Across::kColumns});
    }
    return edges;
}

std::vector<Edge> TagEdges(const Board& board) {
    constexpr double kFrame = 1.0 / 8;  // of a tag of the family tag36h11
    constexpr double kShare = 0.8;
    const double gap = (board.square_m - board.tag_m) / board.tag_m;
    const double reach = kShare * std::min(kFrame, gap);
    std::vector<Edge> edges;
    for (int tag = 0; tag < board.tags(); ++tag) {
        for (int side = 0; side < 4; ++side) {
            edges.push_back({4 * tag + side, 4 * tag + (side + 1) % 4, reach,
                             side % 2 == 0 ? Across::kRows : Across::kColumns});
        }
    }
    return edges;
}

/// Linear between pixels; empty outside the picture.
std::optional<double> LevelAt(const cv::Mat& grey, const Vector2d& at) {
    const double left = std::floor(at.x());
    const double top = std::floor(at.y());
    if (left < 0 || top < 0 || left + 1 >= grey.cols || top + 1 >= grey.rows) return std::nullopt;
    const auto x = static_cast<int>(left);
    const auto y = static_cast<int>(top);
    const double u = at.x() - left;
    const double v = at.y() - top;
    return (1 - v) * ((1 - u) * grey.at<std::uint8_t>(y, x) + u * grey.at<std::uint8_t>(y, x + 1)) +
           v * ((1 - u) * grey.at<std::uint8_t>(y + 1, x) +
                u * grey.at<std::uint8_t>(y + 1, x + 1));
}

/// Levels along a line across the edge, from one side to the other.
std::vector<double> Profile(const cv::Mat& grey, const Vector2d& middle, const Vector2d& step,
                            int half) {
    std::vector<double> levels;
    for (int i = -half; i <= half; ++i) {
        const auto level = LevelAt(grey, middle + i * step);
        if (!level) return {};
        levels.push_back(*level);
    }
    return levels;
}

/// Where a rising profile passes `level`, in steps.
double Crossing(const std::vector<double>& levels, double level) {
    std::size_t i = 1;
    while (i + 1 < levels.size() && levels[i] < level) ++i;
    const double rise = levels[i] - levels[i - 1];
    return static_cast<double>(i) - 1 + (rise > 0 ? (level - levels[i - 1]) / rise : 0.5);
}

/// Of the normal distribution that smears a step so that it takes so many steps from a fifth to
/// four fifths of its height. Empty where there is no step.
std::optional<double> Smear(std::vector<double> levels) {
    constexpr double kFifths = 2 * 0.8416;  // standard deviations from one to four fifths
    constexpr double kLeastStep = 20;       // grey levels
    if (levels.empty()) return std::nullopt;
    if (levels.front() > levels.back()) std::ranges::reverse(levels);
    const double low = levels.front();
    const double step = levels.back() - low;
    if (step < kLeastStep) return std::nullopt;
    return (Crossing(levels, low + 0.8 * step) - Crossing(levels, low + 0.2 * step)) / kFifths;
}

std::optional<double> EdgeBlur_px(const cv::Mat& grey, const Vector2d& from, const Vector2d& to,
                                  double reach) {
    constexpr double kStep_px = 0.25;
    constexpr double kShortest_px = 1.5;
    const double length_px = (to - from).norm();
    const double reach_px = reach * length_px;
    if (reach_px < kShortest_px) return std::nullopt;
    const Vector2d along = (to - from) / length_px;
    const Vector2d across = kStep_px * Vector2d(-along.y(), along.x());
    const auto half = static_cast<int>(reach_px / kStep_px);
    const auto steps = Smear(Profile(grey, (from + to) / 2, across, half));
    if (!steps) return std::nullopt;
    return *steps * kStep_px;
}

/// 0 of too few edges.
double MedianOfEnough(std::vector<double>& blurs_px) {
    constexpr std::size_t kFewest = 4;
    return blurs_px.size() < kFewest ? 0 : Median(std::move(blurs_px));
}

}  // namespace

std::optional<double> BoardBlur_px(const cv::Mat& grey, const Board& board,
                                   const SeenCorners& corners) {
    std::map<int, Vector2d> at_px;
    for (const SeenCorner& corner : corners) at_px[corner.index] = corner.at_px;
    std::array<std::vector<double>, 2> blurs_px;
    for (const Edge& edge :
         board.pattern == Pattern::kTags ? TagEdges(board) : SquareEdges(board)) {
        const auto from = at_px.find(edge.from);
        const auto to = at_px.find(edge.to);
        if (from == at_px.end() || to == at_px.end()) continue;
        if (const auto blur = EdgeBlur_px(grey, from->second, to->second, edge.reach))
            blurs_px.at(static_cast<std::size_t>(edge.across)).push_back(*blur);
    }
    const double blur_px = std::max(MedianOfEnough(blurs_px[0]), MedianOfEnough(blurs_px[1]));
    if (blur_px <= 0) return std::nullopt;
    return blur_px;
}

}  // namespace hitchview::calib
