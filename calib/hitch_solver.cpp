#include "calib/hitch_solver.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>
#include <set>

#include "calib/hitch_adjustment.hpp"
#include "calib/median.hpp"

namespace hitchview::calib {
namespace {

using Eigen::Isometry3d;
using Eigen::Matrix3d;
using Eigen::MatrixXd;
using Eigen::Vector3d;
using Kept = KeptHitchCorners;

constexpr double kFirstSigma_px = 0.3;
constexpr double kFarthest = 4.5;
constexpr int kRounds = 3;

double Yaw(const Matrix3d& R_tractor_trailer) {
    return std::atan2(R_tractor_trailer(1, 0), R_tractor_trailer(0, 0));
}

/// Which corners are no farther off than this.
Kept Within(double farthest_px, const HitchProblem& problem, const HitchPlaces& places) {
    Kept kept;
    for (const Sighting& sighting : problem.sightings) {
        std::vector<bool>& of_sighting = kept.emplace_back();
        for (const double error : HitchPredictor(problem, places).Errors(sighting))
            of_sighting.push_back(error <= farthest_px);
    }
    return kept;
}

double MedianError(const HitchProblem& problem, const HitchPlaces& places) {
    std::vector<double> errors;
    for (const Sighting& sighting : problem.sightings) {
        for (const double error : HitchPredictor(problem, places).Errors(sighting)) {
            if (std::isfinite(error)) errors.push_back(error);
        }
    }
    if (errors.empty()) return 0;
    return Median(std::move(errors));
}

double Rms(const HitchProblem& problem, const HitchPlaces& places, const Kept& kept) {
    double sum = 0;
    double count = 0;
    for (std::size_t i = 0; i < kept.size(); ++i) {
        const auto errors = HitchPredictor(problem, places).Errors(problem.sightings[i]);
        for (std::size_t k = 0; k < errors.size(); ++k) {
            if (!kept[i][k]) continue;
            sum += errors[k] * errors[k];
            ++count;
        }
    }
    return count > 0 ? std::sqrt(sum / count) : std::numeric_limits<double>::infinity();
}

void DescribeShots(const HitchPlaces& places, const MatrixXd& covariance, HitchSolution& solution) {
    for (std::size_t i = 0; i < places.shots.size(); ++i) {
        const Matrix3d& R = places.R_tractor_trailer[i];
        ShotArticulation shot{.shot = places.shots[i], .yaw_rad = Yaw(R)};
        // The turn is about the trailer's axes, of which z is nearly the tractor's.
        const auto at = static_cast<Eigen::Index>(6 + 3 * i + 2);
        shot.sigma_rad = std::sqrt(covariance(at, at));
        shot.pitch_rad = -std::asin(std::clamp(R(2, 0), -1.0, 1.0));
        shot.roll_rad = std::atan2(R(2, 1), R(2, 2));
        solution.shots.push_back(shot);
    }
}

void DescribeRest(const HitchProblem& problem, const HitchPlaces& places, const Kept& kept,
                  HitchSolution& solution) {
    const HitchPredictor predictor(problem, places);
    for (std::size_t i = 0; i < kept.size(); ++i) {
        if (predictor.ShotOf(problem.sightings[i]) &&
            2 * std::ranges::count(kept[i], true) < std::ssize(kept[i]))
            solution.outliers.push_back(i);
    }
    std::set<std::string> loose;
    for (const Sighting& sighting : problem.sightings) loose.insert(sighting.shot);
    for (const std::string& shot : places.shots) loose.erase(shot);
    solution.loose_shots.assign(loose.begin(), loose.end());
}

/// Yaw 0 is the mean of the straight shots.
void Straighten(const HitchProblem& problem, HitchSolution& solution) {
    double sum = 0;
    double variance = 0;
    int count = 0;
    for (const ShotArticulation& shot : solution.shots) {
        if (std::ranges::find(problem.straight, shot.shot) == problem.straight.end()) continue;
        sum += shot.yaw_rad;
        variance += shot.sigma_rad * shot.sigma_rad;
        ++count;
    }
    if (count == 0) return;
    solution.straight_rad = sum / count;
    solution.straight_sigma_rad = std::sqrt(variance) / count;
    for (ShotArticulation& shot : solution.shots)
        shot.yaw_rad = std::remainder(shot.yaw_rad - solution.straight_rad, 2 * std::numbers::pi);
}

}  // namespace

std::optional<HitchSolution> SolveHitch(const HitchProblem& problem) {
    auto places = FirstHitch(problem);
    if (!places) return std::nullopt;
    Kept kept = Within(std::numeric_limits<double>::max(), problem, *places);
    if (!HitchAdjustment(problem, kept, kFirstSigma_px, true, *places).Solve()) return std::nullopt;
    HitchSolution solution;
    // The median distance of two normal coordinates is 1.1774 standard deviations of one.
    solution.sigma_px = std::max(0.01, MedianError(problem, *places) / 1.1774);
    std::optional<HitchInformation> information;
    for (int round = 0; round < kRounds; ++round) {
        kept = Within(kFarthest * solution.sigma_px, problem, *places);
        HitchAdjustment adjustment(problem, kept, solution.sigma_px, false, *places);
        if (!adjustment.Solve()) return std::nullopt;
        information = adjustment.Information();
        if (!information) return std::nullopt;
        solution.sigma_px = std::max(0.01, solution.sigma_px * information->pixel_scale);
    }
    const Eigen::VectorXd sigma = information->covariance.diagonal().cwiseSqrt();
    solution.hitch_tractor_m = places->hitch.head<3>();
    solution.hitch_trailer_m = places->hitch.tail<3>();
    solution.sigma_tractor_m = sigma.head<3>();
    solution.sigma_trailer_m = sigma.segment<3>(3);
    solution.height_is_measured = information->height_is_measured;
    solution.rms_px = Rms(problem, *places, kept);
    DescribeShots(*places, information->covariance, solution);
    DescribeRest(problem, *places, kept, solution);
    Straighten(problem, solution);
    return solution;
}

RigCalibration WithHitch(const RigCalibration& rig, const HitchSolution& solution) {
    Isometry3d T_hitch_tractor = Isometry3d::Identity();
    T_hitch_tractor.translation() = -solution.hitch_tractor_m;
    Isometry3d T_hitch_trailer(Eigen::AngleAxisd(solution.straight_rad, Vector3d::UnitZ()));
    T_hitch_trailer.translation() = -(T_hitch_trailer.linear() * solution.hitch_trailer_m);
    RigCalibration result = rig;
    for (auto& [name, camera] : result.cameras) {
        algo::CameraGeometry geometry = camera.Geometry();
        geometry.T_unit_camera =
            (camera.unit == algo::Unit::kTractor ? T_hitch_tractor : T_hitch_trailer) *
            geometry.T_unit_camera;
        camera = CalibratedCamera::From(camera.unit, geometry);
    }
    return result;
}

}  // namespace hitchview::calib
