#include "calib/hitch_solver.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>

#include "calib/hitch_errors.hpp"
#include "calib/hitch_start.hpp"
#include "calib/normal_equations.hpp"
#include "calib/text.hpp"

namespace hitchview::calib {
namespace {

using Eigen::Isometry3d;
using Eigen::Matrix3d;
using Eigen::MatrixXd;
using Eigen::Vector3d;
using Turn = std::array<double, 3>;
using Kept = std::vector<std::vector<bool>>;

constexpr double kDegree = std::numbers::pi / 180;
constexpr double kLean_rad = 3 * kDegree;
/// The given height counts so much: pictures of a trailer that pitches know better.
constexpr double kHeight_m = 0.05;
constexpr double kFirstSigma_px = 0.3;
constexpr double kFarthest = 4.5;
constexpr double kOrdinaryError = 3;
constexpr int kRounds = 3;

double Yaw(const Matrix3d& R_tractor_trailer) {
    return std::atan2(R_tractor_trailer(1, 0), R_tractor_trailer(0, 0));
}

/// Distances of a sighting's corners from where the places put them; infinite where there are none.
class Predictor {
 public:
    Predictor(const HitchProblem& problem, const HitchPlaces& places)
        : problem_(problem), places_(places) {}

    /// Shot of a sighting that can be used.
    [[nodiscard]] std::optional<std::size_t> ShotOf(const Sighting& sighting) const {
        const auto at = std::ranges::find(places_.shots, sighting.shot);
        if (at == places_.shots.end() || !places_.target_is_placed[sighting.target])
            return std::nullopt;
        return static_cast<std::size_t>(at - places_.shots.begin());
    }

    [[nodiscard]] std::vector<double> Errors(const Sighting& sighting) const {
        std::vector<double> errors(sighting.corners.size(),
                                   std::numeric_limits<double>::infinity());
        const auto shot = ShotOf(sighting);
        if (!shot) return errors;
        const CalibratedCamera& camera = problem_.cameras[sighting.camera];
        algo::CameraModel everywhere = camera.model;
        everywhere.max_theta_rad = 3.14;
        const Isometry3d T_camera_target =
            (T_world_unit(*shot, camera.unit) * camera.Geometry().T_unit_camera).inverse() *
            places_.T_world_target[sighting.target];
        for (std::size_t i = 0; i < errors.size(); ++i) {
            const SeenCorner& seen = sighting.corners[i];
            const auto at = everywhere.Project(
                T_camera_target * problem_.targets[sighting.target].board.Corner(seen.index));
            if (at) errors[i] = (*at - seen.at_px).norm();
        }
        return errors;
    }

 private:
    [[nodiscard]] Isometry3d T_world_unit(std::size_t shot, algo::Unit unit) const {
        if (unit == algo::Unit::kTractor) return places_.T_world_tractor[shot];
        Isometry3d T_tractor_trailer = Isometry3d::Identity();
        T_tractor_trailer.linear() = places_.R_tractor_trailer[shot];
        T_tractor_trailer.translation() =
            places_.hitch.head<3>() - places_.R_tractor_trailer[shot] * places_.hitch.tail<3>();
        return places_.T_world_tractor[shot] * T_tractor_trailer;
    }

    const HitchProblem& problem_;
    const HitchPlaces& places_;
};

/// One adjustment of everything. Unknowns of Covariance: the hitch point in both frames, then the
/// turn of each shot.
class HitchAdjustment {
 public:
    HitchAdjustment(const HitchProblem& problem, const Kept& kept, double sigma_px, bool robust,
                    HitchPlaces& places)
        : problem_(problem),
          places_(places),
          first_(places),
          sigma_px_(sigma_px),
          robust_(robust),
          tractors_(places.shots.size(), PlaceChange{}),
          turns_(places.shots.size(), Turn{}),
          targets_(problem.targets.size(), PlaceChange{}) {
        for (const CalibratedCamera& camera : problem.cameras) {
            lenses_.emplace_back(camera.model);
            T_camera_unit_.push_back(camera.Geometry().T_unit_camera.inverse());
        }
        AddBlocks();
        const Predictor predictor(problem, first_);
        for (std::size_t i = 0; i < kept.size(); ++i) {
            const auto shot = predictor.ShotOf(problem.sightings[i]);
            if (shot) AddSighting(problem.sightings[i], *shot, kept[i]);
        }
        AddKnowledge();
    }

    bool Solve() {
        ceres::Solver::Summary summary;
        ceres::Solve(SolverSettings(), &all_, &summary);
        for (std::size_t i = 0; i < turns_.size(); ++i) {
            places_.T_world_tractor[i] = Changed(first_.T_world_tractor[i], tractors_[i]);
            places_.R_tractor_trailer[i] =
                first_.R_tractor_trailer[i] * Rotation(Vector3d(turns_[i].data()));
        }
        for (std::size_t i = 0; i < targets_.size(); ++i)
            places_.T_world_target[i] = Changed(first_.T_world_target[i], targets_[i]);
        return summary.IsSolutionUsable();
    }

    struct Information {
        MatrixXd covariance;
        double pixel_scale;
        bool height_is_measured;
    };
    std::optional<Information> Inform() {
        const std::vector<double*> unknowns = Unknowns();
        const auto corners = NormalEquations::Of(all_, corners_, unknowns);
        const auto leans = NormalEquations::Of(all_, leans_, unknowns);
        const auto height = NormalEquations::Of(all_, {height_}, unknowns);
        const MatrixXd pictures = corners.matrix + leans.matrix;
        const auto covariance = InverseOfNormal(pictures + height.matrix);
        if (!covariance) return std::nullopt;
        const double sigma_m = std::sqrt((*covariance)(2, 2));
        constexpr double kTellsMore = 0.5;
        return Information{*covariance, corners.ErrorScale(*covariance),
                           sigma_m < kTellsMore * kHeight_m};
    }

 private:
    void AddBlocks() {
        all_.AddParameterBlock(places_.hitch.data(), 6);
        for (PlaceChange& tractor : tractors_) all_.AddParameterBlock(tractor.data(), 6);
        for (Turn& turn : turns_) all_.AddParameterBlock(turn.data(), 3);
        all_.SetParameterBlockConstant(tractors_.front().data());
    }

    ceres::LossFunction* Loss() const {
        return robust_ ? new ceres::CauchyLoss(kOrdinaryError) : nullptr;
    }

    void AddSighting(const Sighting& sighting, std::size_t shot, const std::vector<bool>& kept) {
        for (std::size_t i = 0; i < kept.size(); ++i) {
            if (!kept[i]) continue;
            const SeenCorner& corner = sighting.corners[i];
            const TractorCornerError seen{
                lenses_[sighting.camera],
                T_camera_unit_[sighting.camera],
                first_.T_world_tractor[shot],
                first_.T_world_target[sighting.target],
                problem_.targets[sighting.target].board.Corner(corner.index),
                corner.at_px,
                sigma_px_};
            corners_.push_back(problem_.cameras[sighting.camera].unit == algo::Unit::kTractor
                                   ? AddToTractor(seen, shot, sighting.target)
                                   : AddToTrailer(seen, shot, sighting.target));
        }
    }

    ceres::ResidualBlockId AddToTractor(const TractorCornerError& seen, std::size_t shot,
                                        std::size_t target) {
        using Error = ceres::AutoDiffCostFunction<TractorCornerError, 2, 6, 6>;
        return all_.AddResidualBlock(new Error(new TractorCornerError(seen)), Loss(),
                                     tractors_[shot].data(), targets_[target].data());
    }

    ceres::ResidualBlockId AddToTrailer(const TractorCornerError& seen, std::size_t shot,
                                        std::size_t target) {
        using Error = ceres::AutoDiffCostFunction<TrailerCornerError, 2, 6, 3, 6, 6>;
        return all_.AddResidualBlock(
            new Error(new TrailerCornerError{seen, first_.R_tractor_trailer[shot]}), Loss(),
            tractors_[shot].data(), turns_[shot].data(), places_.hitch.data(),
            targets_[target].data());
    }

    void AddKnowledge() {
        for (std::size_t i = 0; i < turns_.size(); ++i) {
            leans_.push_back(
                all_.AddResidualBlock(new ceres::AutoDiffCostFunction<LeanError, 2, 3>(
                                          new LeanError{first_.R_tractor_trailer[i], kLean_rad}),
                                      nullptr, turns_[i].data()));
        }
        height_ = all_.AddResidualBlock(new ceres::AutoDiffCostFunction<HeightError, 1, 6>(
                                            new HeightError{problem_.height_m, kHeight_m}),
                                        nullptr, places_.hitch.data());
    }

    std::vector<double*> Unknowns() {
        std::vector<double*> unknowns{places_.hitch.data()};
        for (Turn& turn : turns_) unknowns.push_back(turn.data());
        for (std::size_t i = 1; i < tractors_.size(); ++i) unknowns.push_back(tractors_[i].data());
        for (PlaceChange& target : targets_) {
            if (all_.HasParameterBlock(target.data())) unknowns.push_back(target.data());
        }
        return unknowns;
    }

    const HitchProblem& problem_;
    HitchPlaces& places_;
    HitchPlaces first_;
    double sigma_px_;
    bool robust_;
    std::vector<LensParameters> lenses_;
    std::vector<Isometry3d> T_camera_unit_;
    std::vector<PlaceChange> tractors_;
    std::vector<Turn> turns_;
    std::vector<PlaceChange> targets_;
    ceres::Problem all_;
    std::vector<ceres::ResidualBlockId> corners_;
    std::vector<ceres::ResidualBlockId> leans_;
    ceres::ResidualBlockId height_ = nullptr;
};

/// Which corners are no farther off than this.
Kept Within(double farthest_px, const HitchProblem& problem, const HitchPlaces& places) {
    Kept kept;
    for (const Sighting& sighting : problem.sightings) {
        std::vector<bool>& of_sighting = kept.emplace_back();
        for (const double error : Predictor(problem, places).Errors(sighting))
            of_sighting.push_back(error <= farthest_px);
    }
    return kept;
}

double MedianError(const HitchProblem& problem, const HitchPlaces& places) {
    std::vector<double> errors;
    for (const Sighting& sighting : problem.sightings) {
        for (const double error : Predictor(problem, places).Errors(sighting)) {
            if (std::isfinite(error)) errors.push_back(error);
        }
    }
    if (errors.empty()) return 0;
    const auto middle = errors.begin() + std::ssize(errors) / 2;
    std::ranges::nth_element(errors, middle);
    return *middle;
}

double Rms(const HitchProblem& problem, const HitchPlaces& places, const Kept& kept) {
    double sum = 0;
    double count = 0;
    for (std::size_t i = 0; i < kept.size(); ++i) {
        const auto errors = Predictor(problem, places).Errors(problem.sightings[i]);
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
    std::optional<HitchAdjustment::Information> information;
    for (int round = 0; round < kRounds; ++round) {
        kept = Within(kFarthest * solution.sigma_px, problem, *places);
        HitchAdjustment adjustment(problem, kept, solution.sigma_px, false, *places);
        if (!adjustment.Solve()) return std::nullopt;
        information = adjustment.Inform();
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
