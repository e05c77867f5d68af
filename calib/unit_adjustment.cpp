#include "calib/unit_adjustment.hpp"

#include <Eigen/Cholesky>
#include <cmath>
#include <deque>

#include "calib/far_matches.hpp"
#include "calib/normal_equations.hpp"
#include "calib/unit_errors.hpp"

namespace hitchview::calib {
namespace {

/// Of the robust loss, in standard deviations.
constexpr double kOrdinaryError = 3.0;
/// Of the robust loss of matches in the open: many are wrong, or near and moving.
constexpr double kOrdinaryMatch = 1.5;
constexpr double kMatchSigma_px = 0.5;
constexpr double kNearestFar_m = 10;
/// Matches beyond some hundred metres count as infinitely far; nearer ones have the distance that
/// suits them best, so they tell nothing along the line between the cameras.
constexpr double kFarSigma_per_m = 1.0 / 5000;
constexpr double kFarEnough = 12;

}  // namespace

KeptCorners AllCorners(const UnitProblem& problem, const CameraGraph& graph) {
    KeptCorners kept;
    for (std::size_t i = 0; i < problem.sightings.size(); ++i)
        kept.emplace_back(problem.sightings[i].corners.size(), graph.node_of[i].has_value());
    return kept;
}

struct UnitAdjustment::Blocks {
    Blocks(const UnitProblem& unit, const CameraGraph& unit_graph, const KeptCorners& kept,
           const UnitAdjustmentOptions& adjustment, const UnitPlaces& start)
        : problem(unit),
          graph(unit_graph),
          options(adjustment),
          first(start),
          changes(unit.cameras.size() + unit_graph.nodes.size(), PlaceChange{}),
          sizes(start.size) {
        for (const UnitCamera& camera : problem.cameras) lenses.emplace_back(camera.model);
        for (PlaceChange& change : changes) all.AddParameterBlock(change.data(), 6);
        for (double& size : sizes) all.AddParameterBlock(&size, 1);
        for (std::size_t i = 0; i < kept.size(); ++i) {
            if (graph.node_of[i]) AddSighting(problem.sightings[i], *graph.node_of[i], kept[i]);
        }
        if (!options.only) AddKnowledge();
        HoldSizes();
        HoldOthers();
    }

    double* Camera(std::size_t i) { return changes[i].data(); }
    double* Node(std::size_t i) { return changes[problem.cameras.size() + i].data(); }

    ceres::LossFunction* Loss(double ordinary) const {
        return options.robust ? new ceres::CauchyLoss(ordinary) : nullptr;
    }

    void AddSighting(const Sighting& sighting, std::size_t node, const std::vector<bool>& kept) {
        using Error = ceres::AutoDiffCostFunction<SightedCornerError, 2, 6, 6, 1>;
        for (std::size_t i = 0; i < kept.size(); ++i) {
            if (!kept[i]) continue;
            const SeenCorner& seen = sighting.corners[i];
            auto* const error =
                new SightedCornerError{lenses[sighting.camera],
                                       first.T_unit_camera[sighting.camera],
                                       first.T_unit_target[node],
                                       problem.targets[sighting.target].board.Corner(seen.index),
                                       seen.at_px,
                                       options.sigma_px};
            corners.push_back(all.AddResidualBlock(new Error(error), Loss(kOrdinaryError),
                                                   Camera(sighting.camera), Node(node),
                                                   &sizes[sighting.target]));
        }
    }

    /// What ties the places to the unit frame, and what is far away.
    void AddKnowledge() {
        for (std::size_t i = 0; i < graph.nodes.size(); ++i) {
            if (graph.nodes[i].shot.empty()) AddSurvey(i, problem.targets[graph.nodes[i].target]);
        }
        for (std::size_t i = 0; i < problem.cameras.size(); ++i) {
            if (problem.cameras[i].pose) AddPose(i, *problem.cameras[i].pose);
        }
        for (const FarMatch& match : problem.far_matches) AddMatch(match);
    }

    void AddSurvey(std::size_t node, const UnitTarget& target) {
        using Error = ceres::AutoDiffCostFunction<SurveyError, 3, 6, 1>;
        for (const SurveyedCorner& corner : target.surveyed) {
            auto* const error = new SurveyError{first.T_unit_target[node], corner, target.sigma_m};
            priors.push_back(all.AddResidualBlock(new Error(error), Loss(kOrdinaryError),
                                                  Node(node), &sizes[graph.nodes[node].target]));
        }
    }

    void AddPose(std::size_t camera, const MeasuredPose& pose) {
        using Error = ceres::AutoDiffCostFunction<PoseError, 6, 6>;
        auto* const error = new PoseError{first.T_unit_camera[camera], pose};
        priors.push_back(
            all.AddResidualBlock(new Error(error), Loss(kOrdinaryError), Camera(camera)));
    }

    void AddMatch(const FarMatch& match) {
        using Error = ceres::AutoDiffCostFunction<FarMatchError, 2, 6, 6, 1>;
        double angle_rad = 0;
        const auto inverse_start =
            BestInverseDistance(match, problem, first.T_unit_camera, angle_rad);
        if (!inverse_start) return;
        inverse_m.push_back(*inverse_start);
        double* const inverse = &inverse_m.back();
        auto* const error =
            new FarMatchError{lenses[match.second],
                              first.T_unit_camera[match.first],
                              first.T_unit_camera[match.second],
                              problem.cameras[match.first].model.Unproject(match.first_px).value(),
                              match.second_px,
                              std::sqrt(2.0) * kMatchSigma_px};
        matches.push_back(all.AddResidualBlock(new Error(error),
                                               new ceres::CauchyLoss(kOrdinaryMatch),
                                               Camera(match.first), Camera(match.second), inverse));
        all.AddResidualBlock(new ceres::AutoDiffCostFunction<AtInfinityError, 1, 1>(
                                 new AtInfinityError{kFarSigma_per_m}),
                             new ceres::TukeyLoss(kFarEnough), inverse);
        all.SetParameterLowerBound(inverse, 0, 0);
        all.SetParameterUpperBound(inverse, 0, 1 / kNearestFar_m);
    }

    void HoldSizes() {
        for (std::size_t i = 0; i < sizes.size(); ++i) {
            if (options.free_size != i) all.SetParameterBlockConstant(&sizes[i]);
        }
    }

    void HoldOthers() {
        if (!options.only) return;
        for (std::size_t i = 0; i < changes.size(); ++i) {
            if (i != *options.only) all.SetParameterBlockConstant(changes[i].data());
        }
    }

    /// The places that may change, in the order of UnitInformation.
    std::vector<double*> Unknowns() {
        std::vector<double*> unknowns;
        for (std::size_t i = 0; i < changes.size(); ++i) {
            if (!options.only || i == *options.only) unknowns.push_back(changes[i].data());
        }
        if (options.free_size) unknowns.push_back(&sizes[*options.free_size]);
        return unknowns;
    }

    const UnitProblem& problem;
    const CameraGraph& graph;
    UnitAdjustmentOptions options;
    UnitPlaces first;
    std::vector<LensParameters> lenses;
    std::vector<PlaceChange> changes;  ///< of cameras, then nodes
    std::vector<double> sizes;
    std::deque<double> inverse_m;  ///< of each match; a deque, because the problem borrows them
    ceres::Problem all;
    std::vector<ceres::ResidualBlockId> corners;
    std::vector<ceres::ResidualBlockId> priors;
    std::vector<ceres::ResidualBlockId> matches;
    double cost = 0;
};

UnitAdjustment::UnitAdjustment(const UnitProblem& problem, const CameraGraph& graph,
                               const KeptCorners& kept, const UnitAdjustmentOptions& options,
                               UnitPlaces& places)
    : blocks_(std::make_unique<Blocks>(problem, graph, kept, options, places)), places_(places) {}

UnitAdjustment::~UnitAdjustment() = default;

bool UnitAdjustment::Solve() {
    ceres::Solver::Summary summary;
    ceres::Solve(SolverSettings(), &blocks_->all, &summary);
    blocks_->cost = summary.final_cost;
    for (std::size_t i = 0; i < places_.T_unit_camera.size(); ++i)
        places_.T_unit_camera[i] = Changed(blocks_->first.T_unit_camera[i], blocks_->changes[i]);
    const std::size_t cameras = places_.T_unit_camera.size();
    for (std::size_t i = 0; i < places_.T_unit_target.size(); ++i)
        places_.T_unit_target[i] =
            Changed(blocks_->first.T_unit_target[i], blocks_->changes[cameras + i]);
    places_.size = blocks_->sizes;
    return summary.IsSolutionUsable();
}

double UnitAdjustment::cost() const {
    return blocks_->cost;
}

std::optional<UnitInformation> UnitAdjustment::Information() {
    const std::vector<double*> unknowns = blocks_->Unknowns();
    const auto corners = NormalEquations::Of(blocks_->all, blocks_->corners, unknowns);
    const auto priors = NormalEquations::Of(blocks_->all, blocks_->priors, unknowns);
    const auto matches = NormalEquations::WithoutLast(blocks_->all, blocks_->matches, unknowns);
    const Eigen::MatrixXd normal = corners.matrix + priors.matrix + matches.matrix;
    const auto covariance = InverseOfNormal(normal);
    if (!covariance) return std::nullopt;
    UnitInformation information{.covariance = *covariance};
    information.step = -*covariance * (corners.gradient + priors.gradient);
    information.pixel_scale = corners.ErrorScale(*covariance);
    constexpr double kFewestPriors = 3;  // beyond those that fix the frame
    if (priors.FreeRows(*covariance) >= kFewestPriors)
        information.prior_scale = priors.ErrorScale(*covariance);
    return information;
}

}  // namespace hitchview::calib
