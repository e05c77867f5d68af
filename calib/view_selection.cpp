#include "calib/view_selection.hpp"

#include <algorithm>
#include <functional>
#include <limits>

#include "calib/chessboard_detector.hpp"

namespace hitchview::calib {
namespace {

double ErrorsWhenTurned(const LensSolution& solution, const Corners& corners) {
    const auto place = SolvePlace(solution.model, solution.board_m, corners);
    return place ? SquaredErrors(solution.model, solution.board_m, *place, corners)
                 : std::numeric_limits<double>::infinity();
}

Corners Turned(const Corners& corners, const std::vector<int>& turn) {
    Corners turned;
    for (const int index : turn) turned.push_back(corners[static_cast<std::size_t>(index)]);
    return turned;
}

double Median(std::vector<double> values) {
    const auto middle = values.begin() + static_cast<std::ptrdiff_t>(values.size() / 2);
    std::ranges::nth_element(values, middle);
    return *middle;
}

bool IsSamePicture(const Corners& a, const Corners& b) {
    constexpr double kSame = 1e-3;  // px
    double farthest = 0;
    for (std::size_t i = 0; i < a.size(); ++i) farthest = std::max(farthest, (a[i] - b[i]).norm());
    return farthest < kSame;
}

}  // namespace

bool TurnViewsAlike(const LensSolution& solution, LensProblem& problem) {
    constexpr double kClearly = 0.7;  // of the squared errors
    const auto turns = GridTurns(problem.board);
    bool changed = false;
    for (Corners& view : problem.views) {
        double least = kClearly * ErrorsWhenTurned(solution, view);
        Corners best;
        for (std::size_t i = 1; i < turns.size(); ++i) {
            Corners turned = Turned(view, turns[i]);
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
