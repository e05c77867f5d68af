#include "calib/usable_views.hpp"

#include <Eigen/Eigenvalues>
#include <algorithm>

#include "calib/median.hpp"

namespace hitchview::calib {
namespace {

using Eigen::Vector3d;

/// Parts of a board tell its place from this many corners on.
constexpr std::size_t kFewestCorners = 8;

/// Not all in one line, which has no place.
bool AreSpread(const Board& board, const SeenCorners& corners) {
    Vector3d sum = Vector3d::Zero();
    for (const SeenCorner& corner : corners) sum += board.Corner(corner.index);
    const Vector3d middle = sum / static_cast<double>(corners.size());
    Eigen::Matrix2d spread = Eigen::Matrix2d::Zero();
    for (const SeenCorner& corner : corners) {
        const Eigen::Vector2d off = (board.Corner(corner.index) - middle).head<2>();
        spread += off * off.transpose();
    }
    const double least_m2 = 0.1 * board.square_m * board.square_m;
    const Eigen::SelfAdjointEigenSolver<Eigen::Matrix2d> axes(spread, Eigen::EigenvaluesOnly);
    return axes.eigenvalues()[0] > least_m2 * static_cast<double>(corners.size());
}

/// What is half as sharp again as the usual picture of this camera is not in focus or moved.
double MostBlur_px(const std::vector<BoardView>& views) {
    constexpr double kHarmless_px = 1.2;
    constexpr double kTimesUsual = 1.5;
    std::vector<double> blurs_px;
    for (const BoardView& view : views)
        if (view.blur_px) blurs_px.push_back(*view.blur_px);
    if (blurs_px.empty()) return kHarmless_px;
    return std::max(kHarmless_px, kTimesUsual * Median(std::move(blurs_px)));
}

}  // namespace

std::vector<ViewOutcome> LookAtViews(const LensPictures& pictures) {
    const double most_blur_px = MostBlur_px(pictures.views);
    std::vector<ViewOutcome> outcomes;
    for (const BoardView& view : pictures.views) {
        ViewOutcome outcome{.name = view.name, .blur_px = view.blur_px};
        if (view.corners.size() < kFewestCorners || !AreSpread(pictures.board, view.corners))
            outcome.fate = ViewOutcome::Fate::kFewCorners;
        else if (view.blur_px && *view.blur_px > most_blur_px)
            outcome.fate = ViewOutcome::Fate::kSmeared;
        outcomes.push_back(outcome);
    }
    return outcomes;
}

LensProblem ProblemOf(const LensPictures& pictures, const std::vector<ViewOutcome>& outcomes,
                      std::vector<std::size_t>& used) {
    LensProblem problem{.kind = pictures.kind,
                        .width_px = pictures.width_px,
                        .height_px = pictures.height_px,
                        .board = pictures.board,
                        .views = {}};
    for (std::size_t i = 0; i < outcomes.size(); ++i) {
        if (!outcomes[i].is_used()) continue;
        problem.views.push_back(pictures.views[i].corners);
        used.push_back(i);
    }
    return problem;
}

}  // namespace hitchview::calib
