#include "calib/intrinsics.hpp"

#include <algorithm>
#include <cmath>

#include "calib/cross_validation.hpp"
#include "calib/lens_field.hpp"
#include "calib/usable_views.hpp"
#include "calib/view_selection.hpp"

namespace hitchview::calib {
namespace {

using algo::CameraModel;
using Eigen::Vector3d;

constexpr int kFolds = 10;
constexpr int kColumns = ViewSpread::kColumns;
constexpr int kRows = ViewSpread::kRows;

void TurnAlike(LensProblem& problem) {
    constexpr int kMostRounds = 4;
    for (int round = 0; round < kMostRounds; ++round) {
        const auto solution = SolveLens(problem, {.shape = BoardShape::kMeasured, .robust = true});
        if (!solution || !TurnViewsAlike(*solution, problem)) return;
    }
}

/// Takes the outliers out of the problem; `used` keeps the places of the others.
void LeaveOutliersOut(const LensSolution& robust, LensProblem& problem,
                      std::vector<std::size_t>& used, std::vector<ViewOutcome>& outcomes) {
    std::vector<std::size_t> outliers = OutlierViews(robust);
    std::ranges::sort(outliers, std::greater{});
    for (const std::size_t i : outliers) {
        outcomes[used[i]].fate = ViewOutcome::Fate::kOutlier;
        problem.views.erase(problem.views.begin() + static_cast<std::ptrdiff_t>(i));
        used.erase(used.begin() + static_cast<std::ptrdiff_t>(i));
    }
}

struct Candidate {
    LensSolution solution;
    BoardShape shape = BoardShape::kFlat;
    std::optional<double> heldout_rms_px{};
};

std::optional<Candidate> Try(const LensProblem& problem, BoardShape shape) {
    const LensSolverOptions options{.shape = shape, .covariance = true};
    auto solution = SolveLens(problem, options);
    if (!solution) return std::nullopt;
    const LensSolverOptions part{.shape = shape};
    const auto heldout = HeldOutRms(problem, *solution, part, kFolds);
    return Candidate{std::move(*solution), shape, heldout};
}

/// A board is flat unless views that were left out say otherwise.
std::optional<Candidate> Choose(const LensProblem& problem) {
    constexpr double kClearly = 0.9;
    auto flat = Try(problem, BoardShape::kFlat);
    auto measured = Try(problem, BoardShape::kMeasured);
    const bool bulged = flat && measured && flat->heldout_rms_px && measured->heldout_rms_px &&
                        *measured->heldout_rms_px < kClearly * *flat->heldout_rms_px;
    return bulged ? std::move(measured) : std::move(flat);
}

void CountCells(const LensProblem& problem, ViewSpread& spread) {
    for (const SeenCorners& view : problem.views) {
        for (const SeenCorner& corner : view) {
            const int column = static_cast<int>(corner.at_px.x() * kColumns / problem.width_px);
            const int row = static_cast<int>(corner.at_px.y() * kRows / problem.height_px);
            ++spread.corners.at(static_cast<std::size_t>(std::clamp(row, 0, kRows - 1)))
                  .at(static_cast<std::size_t>(std::clamp(column, 0, kColumns - 1)));
        }
    }
    int covered = 0;
    for (const auto& row : spread.corners)
        covered += static_cast<int>(std::ranges::count_if(row, [](int n) { return n > 0; }));
    spread.covered = static_cast<double>(covered) / (kColumns * kRows);
}

ViewSpread Spread(const LensProblem& problem, const LensSolution& solution) {
    ViewSpread spread{.farthest = 1e9};
    CountCells(problem, spread);
    Vector3d end_m = Vector3d::Zero();
    for (const Vector3d& corner : problem.board.Corners()) end_m = end_m.cwiseMax(corner);
    const Vector3d middle = end_m / 2;
    const double width_m = end_m.x();
    for (const Eigen::Isometry3d& T_camera_board : solution.T_camera_board) {
        const Vector3d p_camera = T_camera_board * middle;
        const double along = std::abs(p_camera.normalized().dot(T_camera_board.linear().col(2)));
        spread.most_tilt_rad = std::max(spread.most_tilt_rad, std::acos(std::min(1.0, along)));
        spread.nearest = std::max(spread.nearest, width_m / p_camera.norm());
        spread.farthest = std::min(spread.farthest, width_m / p_camera.norm());
    }
    return spread;
}

double Bulge(const LensProblem& problem, const LensSolution& solution) {
    double farthest = 0;
    for (int i = 0; i < problem.board.count(); ++i) {
        const Vector3d& corner = solution.board_m[static_cast<std::size_t>(i)];
        farthest = std::max(farthest, (corner - problem.board.Corner(i)).norm());
    }
    return farthest;
}

void AddResiduals(const LensProblem& problem, const LensSolution& solution, std::size_t view,
                  int index, std::vector<CornerResidual>& residuals) {
    CameraModel everywhere = solution.model;
    everywhere.max_theta_rad = 3.14;
    for (const SeenCorner& corner : problem.views[view]) {
        const Vector3d& at_m = solution.board_m[static_cast<std::size_t>(corner.index)];
        const auto expected = everywhere.Project(solution.T_camera_board[view] * at_m);
        if (expected) residuals.push_back({index, corner.at_px, corner.at_px - *expected});
    }
}

Intrinsics Describe(const LensProblem& problem, const Candidate& candidate) {
    const LensSolution& solution = candidate.solution;
    Intrinsics result{.model = solution.model, .shape = candidate.shape};
    result.board_m = solution.board_m;
    result.bulge_m = Bulge(problem, solution);
    result.rms_px = solution.rms_px;
    result.heldout_rms_px = candidate.heldout_rms_px;
    result.spread = Spread(problem, solution);
    result.model.max_theta_rad = FieldOf(result.model);
    if (solution.covariance) {
        for (int i = 0; i < solution.covariance->rows(); ++i)
            result.sigma.push_back(std::sqrt((*solution.covariance)(i, i)));
        result.uncertainty =
            ProjectionUncertainty(result.model, *solution.covariance, 2 * kColumns, 2 * kRows);
    }
    return result;
}

}  // namespace

std::optional<Intrinsics> MeasureIntrinsics(const LensPictures& pictures) {
    std::vector<ViewOutcome> outcomes = LookAtViews(pictures);
    std::vector<std::size_t> used;
    LensProblem problem = ProblemOf(pictures, outcomes, used);
    TurnAlike(problem);
    const auto robust = SolveLens(problem, {.shape = BoardShape::kMeasured, .robust = true});
    if (!robust) return std::nullopt;
    LeaveOutliersOut(*robust, problem, used, outcomes);
    const auto chosen = Choose(problem);
    if (!chosen) return std::nullopt;
    Intrinsics result = Describe(problem, *chosen);
    for (std::size_t i = 0; i < used.size(); ++i) {
        outcomes[used[i]].rms_px = chosen->solution.view_rms_px[i];
        AddResiduals(problem, chosen->solution, i, static_cast<int>(used[i]), result.residuals);
    }
    result.views = std::move(outcomes);
    JudgeIntrinsics(result);
    return result;
}

}  // namespace hitchview::calib
