#include "calib/tag_neighbours.hpp"

#include <Eigen/Geometry>
#include <algorithm>
#include <opencv2/calib3d.hpp>

#include "calib/board_pattern.hpp"

namespace hitchview::calib {
namespace {

using Eigen::Vector2d;
using Tags = std::vector<BoardTag>;

Vector2d Middle_m(const Board& board, int index) {
    return TagOrigin_m(board, index) + Vector2d::Constant(board.tag_m / 2);
}

/// Up to four others, the nearest on the board.
Tags Neighbours(const Board& board, const Tags& tags, const BoardTag& of) {
    constexpr std::size_t kNeighbours = 4;
    Tags others;
    for (const BoardTag& tag : tags) {
        if (tag.index != of.index) others.push_back(tag);
    }
    const Vector2d at_m = Middle_m(board, of.index);
    std::ranges::sort(others, {}, [&](const BoardTag& tag) {
        return (Middle_m(board, tag.index) - at_m).squaredNorm();
    });
    others.resize(std::min(others.size(), kNeighbours));
    return others;
}

/// How far a tag lies from where its neighbours expect it, against how far it may be: 1 is too far.
/// What neighbours far away expect is less certain.
double Disagreement(const Board& board, const Tags& tags, const BoardTag& tag) {
    constexpr double kMost = 0.35;  // of the distance between tags, per such distance
    const Tags neighbours = Neighbours(board, tags, tag);
    const auto map = LocalMap::Of(board, neighbours);
    if (!map) return 0;
    const Vector2d at_m = Middle_m(board, tag.index);
    const double far_m = (Middle_m(board, neighbours[0].index) - at_m).norm();
    const double step_px = tag.seen.side_px() * board.square_m / board.tag_m;
    return ((*map)(at_m)-tag.seen.middle_px()).norm() /
           (kMost * step_px * std::max(1.0, far_m / board.square_m));
}

/// Takes away the one that disagrees most. False: all agree.
bool DropWorst(const Board& board, Tags& tags) {
    std::vector<double> disagreements;
    for (const BoardTag& tag : tags) disagreements.push_back(Disagreement(board, tags, tag));
    const auto worst = std::ranges::max_element(disagreements);
    if (worst == disagreements.end() || *worst < 1) return false;
    tags.erase(tags.begin() + (worst - disagreements.begin()));
    return true;
}

}  // namespace

std::array<Vector2d, 4> TagCorners_m(const Board& board, int index) {
    const Vector2d origin_m = TagOrigin_m(board, index);
    const Vector2d along_m(board.tag_m, 0);
    const Vector2d down_m(0, board.tag_m);
    return {origin_m, origin_m + along_m, origin_m + along_m + down_m, origin_m + down_m};
}

Tags TagsOf(const Board& board, std::span<const SeenTag> seen) {
    Tags tags;
    for (const SeenTag& tag : seen) {
        const int index = tag.number - board.first_tag;
        if (index >= 0 && index < board.tags()) tags.push_back({index, tag});
    }
    const std::size_t all = tags.size();
    while (DropWorst(board, tags)) {
    }
    return 3 * tags.size() >= 2 * all ? tags : Tags{};
}

std::optional<LocalMap> LocalMap::Of(const Board& board, std::span<const BoardTag> tags) {
    std::vector<cv::Point2d> from;
    std::vector<cv::Point2d> to;
    for (const BoardTag& tag : tags) {
        const auto corners_m = TagCorners_m(board, tag.index);
        for (std::size_t i = 0; i < 4; ++i) {
            from.emplace_back(corners_m[i].x(), corners_m[i].y());
            to.emplace_back(tag.seen.corners_px[i].x(), tag.seen.corners_px[i].y());
        }
    }
    if (from.empty()) return std::nullopt;
    const cv::Mat H = cv::findHomography(from, to);
    if (H.empty()) return std::nullopt;
    return LocalMap(
        Eigen::Map<const Eigen::Matrix<double, 3, 3, Eigen::RowMajor>>(H.ptr<double>()));
}

Vector2d LocalMap::operator()(const Vector2d& on_board_m) const {
    return (H_picture_board_ * on_board_m.homogeneous()).hnormalized();
}

}  // namespace hitchview::calib
