#include "calib/cross_validation.hpp"

#include <algorithm>
#include <cmath>

#include "calib/view_selection.hpp"

namespace hitchview::calib {
namespace {

constexpr std::size_t kFewestViews = 3;

struct Split {
    LensProblem kept;
    std::vector<SeenCorners> left_out;
};

Split LeaveOut(const LensProblem& problem, const std::vector<int>& numbers, int folds, int fold) {
    Split split{problem, {}};
    split.kept.views.clear();
    for (std::size_t i = 0; i < problem.views.size(); ++i) {
        const bool out = numbers[i] % folds == fold;
        (out ? split.left_out : split.kept.views).push_back(problem.views[i]);
    }
    return split;
}

/// Empty where the lens has no place for one of the views.
std::optional<double> Errors(const LensSolution& solution, const std::vector<SeenCorners>& views) {
    double sum = 0;
    for (const SeenCorners& corners : views) {
        const auto place = SolvePlace(solution.model, solution.board_m, corners);
        if (!place) return std::nullopt;
        sum += SquaredErrors(solution.model, solution.board_m, *place, corners);
    }
    return sum;
}

}  // namespace

std::optional<double> HeldOutRms(const LensProblem& problem, const LensSolution& solution,
                                 const LensSolverOptions& options, int folds) {
    const std::vector<int> numbers = DistinctViews(problem);
    const int distinct = numbers.empty() ? 0 : 1 + *std::ranges::max_element(numbers);
    const int parts = std::min(folds, distinct);
    double sum = 0;
    for (int fold = 0; fold < parts; ++fold) {
        const Split split = LeaveOut(problem, numbers, parts, fold);
        if (split.kept.views.size() < kFewestViews) return std::nullopt;
        const auto kept = SolveLensFrom(solution, split.kept, options);
        const auto errors = kept ? Errors(*kept, split.left_out) : std::nullopt;
        if (!errors) return std::nullopt;
        sum += *errors;
    }
    if (parts == 0) return std::nullopt;
    return std::sqrt(sum / static_cast<double>(CornerCount(problem.views)));
}

}  // namespace hitchview::calib
