#include "calib/lens_solver.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <set>

#include "calib/reprojection_error.hpp"

namespace hitchview::calib {
namespace {

using algo::CameraModel;
using Eigen::Isometry3d;
using Eigen::Vector3d;

/// A corner of a board that is out of place by so much of a square is not worth a pixel yet.
constexpr double kPrintTolerance = 0.05;
/// Of the robust loss.
constexpr double kOrdinaryError = 1.0;  // px

int DistortionCount(CameraModel::Kind kind) {
    return kind == CameraModel::Kind::kPinholeRadtan ? 5 : 4;
}

/// A lens without distortion. Rays of a fisheye may have any direction.
CameraModel PlainLens(const LensProblem& problem, double focal_px) {
    CameraModel model;
    model.kind = problem.kind;
    model.width_px = problem.width_px;
    model.height_px = problem.height_px;
    model.fx_px = model.fy_px = focal_px;
    model.cx_px = (problem.width_px - 1) / 2.0;
    model.cy_px = (problem.height_px - 1) / 2.0;
    model.max_theta_rad = problem.kind == CameraModel::Kind::kPinholeRadtan ? 1.57 : 3.0;
    return model;
}

/// Everything that is solved for.
struct State {
    CameraModel model;
    std::vector<PlaceParameters> places;
    std::vector<Vector3d> board_m;
};

/// The places of all boards for a lens, and how well they fit; infinite where one has none.
template <typename FindPlace>
double FitPlaces(const LensProblem& problem, const FindPlace& find_place, State& state) {
    double sum = 0;
    state.places.clear();
    for (const SeenCorners& corners : problem.views) {
        const auto place = find_place(state.model, state.board_m, corners);
        if (!place) return std::numeric_limits<double>::infinity();
        sum += SquaredErrors(state.model, state.board_m, *place, corners);
        state.places.push_back(Parameters(*place));
    }
    return sum;
}

/// The best of many focal lengths, so that no view has to be of a kind that tells it by itself.
std::optional<State> FirstState(const LensProblem& problem) {
    constexpr double kShortest = 0.2;  // of the width
    constexpr double kLongest = 4.0;
    constexpr double kStep = 1.25;
    std::optional<State> best;
    double least = std::numeric_limits<double>::infinity();
    for (double share = kShortest; share < kLongest; share *= kStep) {
        State state{PlainLens(problem, share * problem.width_px), {}, problem.board.Corners()};
        const double errors = FitPlaces(problem, RoughPlace, state);
        if (errors >= least) continue;
        least = errors;
        best = std::move(state);
    }
    return best;
}

/// One bundle adjustment.
class Adjustment {
 public:
    Adjustment(const LensProblem& problem, const LensSolverOptions& options, State& state)
        : problem_(problem), state_(state), lens_(state.model) {
        for (std::size_t view = 0; view < problem.views.size(); ++view) AddView(view, options);
        for (std::size_t i = 0; i < state.board_m.size(); ++i) AddCorner(i, options.shape);
    }

    void HoldDistortion() { all_.SetParameterBlockConstant(lens_.distortion.data()); }

    bool Solve() {
        ceres::Solver::Options settings = SolverSettings();
        ceres::Solver::Summary summary;
        ceres::Solve(settings, &all_, &summary);
        lens_.CopyTo(state_.model);
        return summary.IsSolutionUsable();
    }

    /// For corners with errors of one pixel.
    std::optional<LensCovariance> Covariance() {
        ceres::Covariance::Options options;
        options.algorithm_type = ceres::DENSE_SVD;
        options.null_space_rank = 0;
        if (all_.NumResiduals() > kLargestDense) options.algorithm_type = ceres::SPARSE_QR;
        ceres::Covariance covariance(options);
        const std::vector<const double*> blocks{lens_.focal_and_centre.data(),
                                                lens_.distortion.data()};
        if (!covariance.Compute(blocks, &all_)) return std::nullopt;
        const int count = 4 + DistortionCount(problem_.kind);
        Eigen::Matrix<double, Eigen::Dynamic, Eigen::Dynamic, Eigen::RowMajor> values(count, count);
        if (!covariance.GetCovarianceMatrix(blocks, values.data())) return std::nullopt;
        return LensCovariance(values);
    }

 private:
    static constexpr int kLargestDense = 200;

    void AddView(std::size_t view, const LensSolverOptions& options) {
        for (const SeenCorner& corner : problem_.views[view]) {
            ceres::CostFunction* const error =
                problem_.kind == CameraModel::Kind::kPinholeRadtan
                    ? CornerError::Create<5>(problem_.kind, corner.at_px)
                    : CornerError::Create<4>(problem_.kind, corner.at_px);
            all_.AddResidualBlock(
                error, options.robust ? new ceres::CauchyLoss(kOrdinaryError) : nullptr,
                lens_.focal_and_centre.data(), lens_.distortion.data(), state_.places[view].data(),
                state_.board_m[static_cast<std::size_t>(corner.index)].data());
        }
    }

    void AddCorner(std::size_t index, BoardShape shape) {
        double* const corner = state_.board_m[index].data();
        if (!all_.HasParameterBlock(corner)) return;
        if (shape == BoardShape::kFlat) {
            all_.SetParameterBlockConstant(corner);
            return;
        }
        all_.AddResidualBlock(ShapeError::Create(problem_.board.Corner(static_cast<int>(index)),
                                                 kPrintTolerance * problem_.board.square_m),
                              nullptr, corner);
    }

    const LensProblem& problem_;
    State& state_;
    LensParameters lens_;
    ceres::Problem all_;
};

/// Distortion grows on large errors of the focal length, so it comes second, and the board's shape
/// after that.
bool Adjust(const LensProblem& problem, const LensSolverOptions& options, State& state) {
    LensSolverOptions flat = options;
    flat.shape = BoardShape::kFlat;
    flat.robust = true;
    {
        Adjustment plain(problem, flat, state);
        plain.HoldDistortion();
        if (!plain.Solve()) return false;
    }
    if (!Adjustment(problem, flat, state).Solve()) return false;
    return Adjustment(problem, options, state).Solve();
}

void Measure(const LensProblem& problem, const State& state, LensSolution& solution) {
    double sum = 0;
    for (std::size_t view = 0; view < problem.views.size(); ++view) {
        solution.T_camera_board.push_back(Place(state.places[view]));
        const double errors = SquaredErrors(state.model, state.board_m,
                                            solution.T_camera_board.back(), problem.views[view]);
        solution.view_rms_px.push_back(
            std::sqrt(errors / static_cast<double>(problem.views[view].size())));
        sum += errors;
    }
    solution.rms_px = std::sqrt(sum / static_cast<double>(CornerCount(problem.views)));
}

/// Corners of the board that are seen in some view.
int DistinctCorners(const std::vector<SeenCorners>& views) {
    std::set<int> seen;
    for (const SeenCorners& view : views)
        for (const SeenCorner& corner : view) seen.insert(corner.index);
    return static_cast<int>(seen.size());
}

/// Of one coordinate of a corner, after what the parameters took up.
double ErrorVariance(const LensProblem& problem, const LensSolverOptions& options, double rms_px) {
    const auto corners = static_cast<double>(CornerCount(problem.views));
    const auto views = static_cast<double>(problem.views.size());
    const double shape =
        options.shape == BoardShape::kMeasured ? 3.0 * DistinctCorners(problem.views) - 6 : 0;
    const double free = 2 * corners - 6 * views - 4 - DistortionCount(problem.kind) - shape;
    return free > 0 ? rms_px * rms_px * corners / free : std::numeric_limits<double>::infinity();
}

std::optional<LensSolution> Finish(const LensProblem& problem, const LensSolverOptions& options,
                                   State& state) {
    LensSolution solution;
    solution.model = state.model;
    solution.board_m = state.board_m;
    Measure(problem, state, solution);
    if (!std::isfinite(solution.rms_px)) return std::nullopt;
    if (options.covariance) {
        solution.covariance = Adjustment(problem, options, state).Covariance();
        if (solution.covariance)
            *solution.covariance *= ErrorVariance(problem, options, solution.rms_px);
    }
    return solution;
}

}  // namespace

std::size_t CornerCount(const std::vector<SeenCorners>& views) {
    std::size_t count = 0;
    for (const SeenCorners& view : views) count += view.size();
    return count;
}

std::optional<LensSolution> SolveLens(const LensProblem& problem,
                                      const LensSolverOptions& options) {
    if (problem.views.empty()) return std::nullopt;
    auto state = FirstState(problem);
    if (!state || !Adjust(problem, options, *state)) return std::nullopt;
    return Finish(problem, options, *state);
}

std::optional<LensSolution> SolveLensFrom(const LensSolution& start, const LensProblem& problem,
                                          const LensSolverOptions& options) {
    State state{start.model, {}, start.board_m};
    if (problem.views.empty() || !std::isfinite(FitPlaces(problem, SolvePlace, state)))
        return std::nullopt;
    if (options.shape == BoardShape::kFlat) state.board_m = problem.board.Corners();
    if (!Adjustment(problem, options, state).Solve()) return std::nullopt;
    return Finish(problem, options, state);
}

}  // namespace hitchview::calib
