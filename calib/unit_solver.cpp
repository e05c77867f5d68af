#include "calib/unit_solver.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

#include "calib/median.hpp"
#include "calib/place_change.hpp"
#include "calib/unit_start.hpp"

namespace hitchview::calib {
namespace {

using Eigen::Isometry3d;
using Eigen::Matrix3d;
using Eigen::Vector3d;

constexpr double kFirstSigma_px = 0.3;
constexpr double kLeastSigma_px = 0.01;
/// In standard deviations: one good corner in 25000 is farther off.
constexpr double kFarthest = 4.5;
constexpr int kRounds = 3;

/// Of a coordinate, from the median distance of all corners (that of two normal coordinates is
/// 1.1774 standard deviations).
double RobustSigma(const UnitProblem& problem, const CameraGraph& graph, const UnitPlaces& places) {
    std::vector<double> distances;
    for (std::size_t i = 0; i < problem.sightings.size(); ++i) {
        if (!graph.node_of[i]) continue;
        const auto of_sighting = CornerErrors(problem, graph, places, i);
        distances.insert(distances.end(), of_sighting.begin(), of_sighting.end());
    }
    if (distances.empty()) return kFirstSigma_px;
    return std::max(kLeastSigma_px, Median(std::move(distances)) / 1.1774);
}

KeptCorners Within(double farthest_px, const UnitProblem& problem, const CameraGraph& graph,
                   const UnitPlaces& places) {
    KeptCorners kept = AllCorners(problem, graph);
    for (std::size_t i = 0; i < kept.size(); ++i) {
        if (!graph.node_of[i]) continue;
        const auto errors = CornerErrors(problem, graph, places, i);
        for (std::size_t k = 0; k < errors.size(); ++k) kept[i][k] = errors[k] <= farthest_px;
    }
    return kept;
}

/// Derivatives of roll, pitch and yaw by the turn of a PlaceChange.
Matrix3d RpyByTurn(const Isometry3d& T_unit_camera) {
    constexpr double kStep = 1e-5;
    Matrix3d derivatives;
    for (int i = 0; i < 3; ++i) {
        PlaceChange plus{};
        PlaceChange minus{};
        plus[static_cast<std::size_t>(i)] = kStep;
        minus[static_cast<std::size_t>(i)] = -kStep;
        const Vector3d difference =
            RpyOf(Changed(T_unit_camera, plus)) - RpyOf(Changed(T_unit_camera, minus));
        for (int k = 0; k < 3; ++k)
            derivatives(k, i) = std::remainder(difference[k], 2 * std::numbers::pi) / (2 * kStep);
    }
    return derivatives;
}

PlacedCamera Describe(const Isometry3d& T_unit_camera,
                      const Eigen::Matrix<double, 6, 6>& covariance) {
    PlacedCamera camera{.T_unit_camera = T_unit_camera};
    camera.rpy_rad = RpyOf(T_unit_camera);
    const Matrix3d by_turn = RpyByTurn(T_unit_camera);
    const Matrix3d of_rpy = by_turn * covariance.topLeftCorner<3, 3>() * by_turn.transpose();
    camera.rpy_sigma_rad = of_rpy.diagonal().cwiseSqrt();
    camera.position_sigma_m = covariance.bottomRightCorner<3, 3>().diagonal().cwiseSqrt();
    return camera;
}

void DescribeSightings(const UnitProblem& problem, const CameraGraph& graph,
                       UnitSolution& solution) {
    std::vector<double> squares(problem.cameras.size(), 0.0);
    for (std::size_t i = 0; i < problem.sightings.size(); ++i) {
        SightingOutcome& outcome = solution.sightings.emplace_back();
        if (!graph.node_of[i]) continue;
        PlacedCamera& camera = solution.cameras[problem.sightings[i].camera];
        const auto errors = CornerErrors(problem, graph, solution.places, i);
        double sum = 0;
        for (std::size_t k = 0; k < errors.size(); ++k) {
            sum += errors[k] * errors[k];
            if (!solution.kept[i][k]) continue;
            ++outcome.kept;
            ++camera.corners;
            squares[problem.sightings[i].camera] += errors[k] * errors[k];
        }
        outcome.rms_px = std::sqrt(sum / static_cast<double>(errors.size()));
        outcome.outlier = 2 * outcome.kept < errors.size();
    }
    for (std::size_t i = 0; i < squares.size(); ++i) {
        PlacedCamera& camera = solution.cameras[i];
        if (camera.corners > 0)
            camera.rms_px = std::sqrt(squares[i] / static_cast<double>(camera.corners));
    }
}

/// Each round knows better which corners do not fit, and how large errors are. Empty: no solution.
std::optional<UnitInformation> SolveWithoutOutliers(const UnitProblem& problem,
                                                    const CameraGraph& graph,
                                                    UnitSolution& solution) {
    std::optional<UnitInformation> information;
    for (int round = 0; round < kRounds; ++round) {
        solution.kept = Within(kFarthest * solution.sigma_px, problem, graph, solution.places);
        UnitAdjustment adjustment(problem, graph, solution.kept, {.sigma_px = solution.sigma_px},
                                  solution.places);
        if (!adjustment.Solve()) return std::nullopt;
        information = adjustment.Information();
        if (!information) return std::nullopt;
        solution.sigma_px = std::max(kLeastSigma_px, solution.sigma_px * information->pixel_scale);
    }
    return information;
}

void DescribeCameras(const UnitProblem& problem, const UnitInformation& information,
                     UnitSolution& solution) {
    solution.prior_scale = information.prior_scale;
    const double scale = std::max(1.0, information.prior_scale);
    const auto unknowns = static_cast<Eigen::Index>(6 * problem.cameras.size());
    solution.covariance = scale * scale * information.covariance.topLeftCorner(unknowns, unknowns);
    for (std::size_t i = 0; i < problem.cameras.size(); ++i) {
        const auto at = static_cast<Eigen::Index>(6 * i);
        solution.cameras.push_back(
            Describe(solution.places.T_unit_camera[i], solution.covariance.block<6, 6>(at, at)));
    }
}

}  // namespace

std::vector<double> CornerErrors(const UnitProblem& problem, const CameraGraph& graph,
                                 const UnitPlaces& places, std::size_t sighting) {
    const Sighting& seen = problem.sightings[sighting];
    const UnitTarget& target = problem.targets[seen.target];
    algo::CameraModel everywhere = problem.cameras[seen.camera].model;
    everywhere.max_theta_rad = 3.14;
    const Isometry3d T_camera_target = places.T_unit_camera[seen.camera].inverse() *
                                       places.T_unit_target[graph.node_of[sighting].value()];
    std::vector<double> errors;
    for (const SeenCorner& corner : seen.corners) {
        const Vector3d p_target = places.size[seen.target] * target.board.Corner(corner.index);
        const auto expected = everywhere.Project(T_camera_target * p_target);
        errors.push_back(expected ? (*expected - corner.at_px).norm()
                                  : std::numeric_limits<double>::infinity());
    }
    return errors;
}

Vector3d RpyOf(const Isometry3d& T_unit_camera) {
    Matrix3d R_camera_body;
    R_camera_body << 0, -1, 0, 0, 0, -1, 1, 0, 0;
    const Matrix3d R = T_unit_camera.linear() * R_camera_body;
    return {std::atan2(R(2, 1), R(2, 2)), std::atan2(-R(2, 0), std::hypot(R(2, 1), R(2, 2))),
            std::atan2(R(1, 0), R(0, 0))};
}

std::optional<UnitSolution> SolveUnit(const UnitProblem& problem, const CameraGraph& graph) {
    const auto start = FirstPlaces(problem, graph);
    if (!start) return std::nullopt;
    return SolveUnitFrom(*start, problem, graph);
}

std::optional<UnitSolution> SolveUnitFrom(const UnitPlaces& start, const UnitProblem& problem,
                                          const CameraGraph& graph) {
    UnitSolution solution{.places = start};
    const KeptCorners all = AllCorners(problem, graph);
    const UnitAdjustmentOptions robust{.sigma_px = kFirstSigma_px, .robust = true};
    if (!UnitAdjustment(problem, graph, all, robust, solution.places).Solve()) return std::nullopt;
    solution.sigma_px = RobustSigma(problem, graph, solution.places);
    const auto information = SolveWithoutOutliers(problem, graph, solution);
    if (!information) return std::nullopt;
    DescribeCameras(problem, *information, solution);
    DescribeSightings(problem, graph, solution);
    return solution;
}

}  // namespace hitchview::calib
