#include "calib/view_selection.hpp"

#include <algorithm>
#include <functional>
#include <limits>

#include "calib/chessboard_detector.hpp"
#include "calib/median.hpp"

namespace hitchview::calib {
namespace {

double ErrorsWhenTurned(const LensSolution& solution, const SeenCorners& corners) {
    const auto place = SolvePlace(solution.model, solution.board_m, corners);
    return place ? SquaredErrors(solution.model, solution.board_m, *place, corners)
                 : std::numeric_limits<double>::infinity();
}

SeenCorners Turned(const SeenCorners& corners, const std::vector<int>& turn) {
    std::vector<Eigen::Vector2d> turned;
    for (const int index : turn) turned.push_back(corners[static_cast<std::size_t>(index)].at_px);
    return AllCorners(turned);
}

bool IsSamePicture(const SeenCorners& a, const SeenCorners& b) {
    constexpr double kSame = 1e-3;  // px
    return std::ranges::equal(a, b, [](const SeenCorner& one, const SeenCorner& other) {
        return one.index == other.index && (one.at_px - other.at_px).norm() < kSame;
    });
}

}  // namespace

bool TurnViewsAlike(const LensSolution& solution, LensProblem& problem) {
    constexpr double kClearly = 0.7;  // of the squared errors
    if (problem.board.pattern != Pattern::kCheckerboard) return false;
    const auto turns = GridTurns(problem.board);
    bool changed = false;
    for (SeenCorners& view : problem.views) {
        double least = kClearly * ErrorsWhenTurned(solution, view);
        SeenCorners best;
        for (std::size_t i = 1; i < turns.size(); ++i) {
            SeenCorners turned = Turned(view, turns[i]);
            const double errors = ErrorsWhenTurned(solution, turned);
            if (errors >= least) continue;
            least = errors;
            best = std::move(turned);
        }
        if (best.empty()) continue;
        view = std::move(best);
        changed = true;
    }
    return changed;
}

std::vector<std::size_t> OutlierViews(const LensSolution& solution) {
    constexpr double kFar = 3.0;       // times the median
    constexpr double kHarmless = 1.0;  // px
    const std::vector<double>& rms_px = solution.view_rms_px;
    const double limit = std::max(kHarmless, kFar * Median(rms_px));
    std::vector<std::size_t> outliers;
    for (std::size_t i = 0; i < rms_px.size(); ++i) {
        if (rms_px[i] > limit) outliers.push_back(i);
    }
    std::ranges::sort(outliers, std::greater{}, [&](std::size_t i) { return rms_px[i]; });
    outliers.resize(std::min(outliers.size(), rms_px.size() / 3));
    return outliers;
}

std::vector<int> DistinctViews(const LensProblem& problem) {
    std::vector<int> numbers;
    int next = 0;
    for (std::size_t i = 0; i < problem.views.size(); ++i) {
        std::size_t j = 0;
        while (j < i && !IsSamePicture(problem.views[j], problem.views[i])) ++j;
        numbers.push_back(j < i ? numbers[j] : next++);
    }
    return numbers;
}

}  // namespace hitchview::calib
