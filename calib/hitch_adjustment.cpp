#include "calib/hitch_adjustment.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>

#include "calib/hitch_errors.hpp"
#include "calib/normal_equations.hpp"

namespace hitchview::calib {
namespace {

using Eigen::Isometry3d;
using Eigen::MatrixXd;
using Eigen::Vector3d;
using Turn = std::array<double, 3>;

constexpr double kLean_rad = 3 * std::numbers::pi / 180;
/// The given height counts so much: pictures of a trailer that pitches know better.
constexpr double kHeight_m = 0.05;
constexpr double kOrdinaryError = 3;  // of the robust loss, in standard deviations

}  // namespace

std::optional<std::size_t> HitchPredictor::ShotOf(const Sighting& sighting) const {
    const auto at = std::ranges::find(places_.shots, sighting.shot);
    if (at == places_.shots.end() || !places_.target_is_placed[sighting.target])
        return std::nullopt;
    return static_cast<std::size_t>(at - places_.shots.begin());
}

std::vector<double> HitchPredictor::Errors(const Sighting& sighting) const {
    std::vector<double> errors(sighting.corners.size(), std::numeric_limits<double>::infinity());
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

Isometry3d HitchPredictor::T_world_unit(std::size_t shot, algo::Unit unit) const {
    if (unit == algo::Unit::kTractor) return places_.T_world_tractor[shot];
    Isometry3d T_tractor_trailer = Isometry3d::Identity();
    T_tractor_trailer.linear() = places_.R_tractor_trailer[shot];
    T_tractor_trailer.translation() =
        places_.hitch.head<3>() - places_.R_tractor_trailer[shot] * places_.hitch.tail<3>();
    return places_.T_world_tractor[shot] * T_tractor_trailer;
}

struct HitchAdjustment::Blocks {
    Blocks(const HitchProblem& problem, const KeptHitchCorners& kept, double sigma_px, bool robust,
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
        const HitchPredictor predictor(problem, first_);
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

    std::optional<HitchInformation> Inform() {
        const std::vector<double*> unknowns = Unknowns();
        const auto corners = NormalEquations::Of(all_, corners_, unknowns);
        const auto leans = NormalEquations::Of(all_, leans_, unknowns);
        const auto height = NormalEquations::Of(all_, {height_}, unknowns);
        const MatrixXd pictures = corners.matrix + leans.matrix;
        const auto covariance = InverseOfNormal(pictures + height.matrix);
        if (!covariance) return std::nullopt;
        const double sigma_m = std::sqrt((*covariance)(2, 2));
        constexpr double kTellsMore = 0.5;
        return HitchInformation{*covariance, corners.ErrorScale(*covariance),
                                sigma_m < kTellsMore * kHeight_m};
    }

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

HitchAdjustment::HitchAdjustment(const HitchProblem& problem, const KeptHitchCorners& kept,
                                 double sigma_px, bool robust, HitchPlaces& places)
    : blocks_(std::make_unique<Blocks>(problem, kept, sigma_px, robust, places)) {}

HitchAdjustment::~HitchAdjustment() = default;

bool HitchAdjustment::Solve() {
    return blocks_->Solve();
}

std::optional<HitchInformation> HitchAdjustment::Information() {
    return blocks_->Inform();
}

}  // namespace hitchview::calib
