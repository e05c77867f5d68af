#include "calib/intrinsics.hpp"

#include <algorithm>
#include <cmath>
#include <set>

#include "calib/cross_validation.hpp"
#include "calib/view_selection.hpp"

namespace hitchview::calib {
namespace {

using algo::CameraModel;
using Eigen::Vector3d;

constexpr int kFolds = 10;
constexpr int kColumns = 8;
constexpr int kRows = 5;

void TurnAlike(LensProblem& problem) {
    constexpr int kMostRounds = 4;
    for (int round = 0; round < kMostRounds; ++round) {
        const auto solution = SolveLens(problem, {.shape = BoardShape::kMeasured, .robust = true});
        if (!solution || !TurnViewsAlike(*solution, problem)) return;
    }
}

/// Takes the outliers out of the problem; `used` keeps the places of the others.
void LeaveOutliersOut(const LensSolution& robust, LensProblem& problem,
                      std::vector<std::size_t>& used) {
    std::vector<std::size_t> outliers = OutlierViews(robust);
    std::ranges::sort(outliers, std::greater{});
    for (const std::size_t i : outliers) {
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

double Covered(const LensProblem& problem) {
    std::set<int> cells;
    for (const SeenCorners& view : problem.views) {
        for (const SeenCorner& corner : view) {
            const int column = static_cast<int>(corner.at_px.x() * kColumns / problem.width_px);
            const int row = static_cast<int>(corner.at_px.y() * kRows / problem.height_px);
            cells.insert(row * kColumns + column);
        }
    }
    return static_cast<double>(cells.size()) / (kColumns * kRows);
}

ViewSpread Spread(const LensProblem& problem, const LensSolution& solution) {
    ViewSpread spread{.covered = Covered(problem), .farthest = 1e9};
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

/// The polynomial may turn back between the last corner seen and the corner of the picture.
double GrowsUpTo(const CameraModel& model) {
    constexpr double kStep = 0.005;
    const double most = model.kind == CameraModel::Kind::kPinholeRadtan ? 1.5 : 3.1;
    CameraModel everywhere = model;
    everywhere.max_theta_rad = 3.14;
    double last = -1;
    double theta = 0;
    for (; theta < most; theta += kStep) {
        const auto at = everywhere.Project({std::sin(theta), 0, std::cos(theta)});
        const double radius = (at->x() - model.cx_px) / model.fx_px;
        if (!(radius > last)) break;
        last = radius;
        if (std::abs(radius) * model.fx_px > std::hypot(model.width_px, model.height_px)) break;
    }
    return std::max(0.05, theta - 2 * kStep);
}

/// The farthest ray that has a pixel in the picture and an inverse.
void LimitField(CameraModel& model) {
    model.max_theta_rad = GrowsUpTo(model);
    double farthest = 0;
    for (const double x : {0.0, model.width_px - 1.0}) {
        for (const double y : {0.0, model.height_px - 1.0}) {
            const auto direction = model.Unproject({x, y});
            if (!direction) return;
            farthest = std::max(farthest, std::acos(std::clamp(direction->z(), -1.0, 1.0)));
        }
    }
    model.max_theta_rad = std::min(model.max_theta_rad, farthest + 0.01);
}

std::vector<ViewOutcome> Outcomes(const std::vector<std::string>& names,
                                  const std::vector<std::size_t>& used,
                                  const LensSolution& solution) {
    std::vector<ViewOutcome> outcomes;
    for (const std::string& name : names) outcomes.push_back({.name = name});
    for (std::size_t i = 0; i < used.size(); ++i) {
        outcomes[used[i]].used = true;
        outcomes[used[i]].rms_px = solution.view_rms_px[i];
    }
    return outcomes;
}

Intrinsics Describe(const LensProblem& problem, const Candidate& candidate) {
    const LensSolution& solution = candidate.solution;
    Intrinsics result{.model = solution.model, .shape = candidate.shape};
    result.board_m = solution.board_m;
    result.bulge_m = Bulge(problem, solution);
    result.rms_px = solution.rms_px;
    result.heldout_rms_px = candidate.heldout_rms_px;
    result.spread = Spread(problem, solution);
    LimitField(result.model);
    if (solution.covariance) {
        for (int i = 0; i < solution.covariance->rows(); ++i)
            result.sigma.push_back(std::sqrt((*solution.covariance)(i, i)));
        result.uncertainty =
            ProjectionUncertainty(result.model, *solution.covariance, 2 * kColumns, 2 * kRows);
    }
    return result;
}

}  // namespace

std::optional<Intrinsics> MeasureIntrinsics(const LensProblem& all,
                                            const std::vector<std::string>& names) {
    LensProblem problem = all;
    TurnAlike(problem);
    const auto robust = SolveLens(problem, {.shape = BoardShape::kMeasured, .robust = true});
    if (!robust) return std::nullopt;
    std::vector<std::size_t> used(problem.views.size());
    for (std::size_t i = 0; i < used.size(); ++i) used[i] = i;
    LeaveOutliersOut(*robust, problem, used);
    const auto chosen = Choose(problem);
    if (!chosen) return std::nullopt;
    Intrinsics result = Describe(problem, *chosen);
    result.views = Outcomes(names, used, chosen->solution);
    JudgeIntrinsics(result);
    return result;
}

}  // namespace hitchview::calib
