#include "calib/pair_turn.hpp"

#include <algorithm>
#include <cmath>
#include <set>
#include <utility>

#include "calib/camera_graph.hpp"
#include "calib/lens_solver.hpp"
#include "calib/reprojection_error.hpp"
#include "calib/unit_adjustment.hpp"

namespace hitchview::calib {
namespace {

using Eigen::Isometry3d;
using Eigen::Matrix3d;
using Eigen::Vector3d;

constexpr std::size_t kFewestFarMatches = 8;

/// A target at one moment.
using Moment = std::pair<std::size_t, std::string>;

std::set<Moment> MomentsOf(const UnitProblem& problem, std::size_t camera) {
    std::set<Moment> moments;
    for (const Sighting& sighting : problem.sightings)
        if (sighting.camera == camera) moments.insert({sighting.target, sighting.shot});
    return moments;
}

std::set<Moment> SharedMoments(const UnitProblem& problem, std::size_t first, std::size_t second) {
    const std::set<Moment> of_first = MomentsOf(problem, first);
    const std::set<Moment> of_second = MomentsOf(problem, second);
    std::set<Moment> shared;
    std::ranges::set_intersection(of_first, of_second, std::inserter(shared, shared.end()));
    return shared;
}

/// The first camera stays; the second may turn, and give way a little.
UnitProblem PairProblem(const UnitProblem& problem, std::size_t first, std::size_t second) {
    UnitProblem pair{.cameras = {problem.cameras[first], problem.cameras[second]},
                     .targets = problem.targets};
    pair.cameras[0].pose->sigma_m = 1e-5;
    pair.cameras[0].pose->sigma_rad = 1e-6;
    pair.cameras[1].pose->sigma_m = 0.01;
    pair.cameras[1].pose->sigma_rad = 0.3;
    const std::set<Moment> shared = SharedMoments(problem, first, second);
    for (const Sighting& sighting : problem.sightings) {
        if (sighting.camera != first && sighting.camera != second) continue;
        if (!shared.contains({sighting.target, sighting.shot})) continue;
        pair.sightings.push_back(sighting);
        pair.sightings.back().camera = sighting.camera == first ? 0 : 1;
    }
    for (const FarMatch& match : problem.far_matches) {
        if (match.first != first || match.second != second) continue;
        pair.far_matches.push_back(match);
        pair.far_matches.back().first = 0;
        pair.far_matches.back().second = 1;
    }
    return pair;
}

/// Where the calibration and the first camera's pictures put everything. Empty: a board has no
/// place.
std::optional<UnitPlaces> Start(const UnitProblem& pair, const CameraGraph& graph) {
    UnitPlaces places;
    for (const UnitCamera& camera : pair.cameras)
        places.T_unit_camera.push_back(camera.pose->T_unit_camera);
    places.T_unit_target.resize(graph.nodes.size(), Isometry3d::Identity());
    places.size.resize(pair.targets.size(), 1.0);
    for (std::size_t i = 0; i < pair.sightings.size(); ++i) {
        const Sighting& sighting = pair.sightings[i];
        if (sighting.camera != 0 || !graph.node_of[i]) continue;
        const auto T_camera_board = SolvePlace(
            pair.cameras[0].model, pair.targets[sighting.target].board.Corners(), sighting.corners);
        if (!T_camera_board) return std::nullopt;
        places.T_unit_target[*graph.node_of[i]] = places.T_unit_camera[0] * *T_camera_board;
    }
    return places;
}

/// Directions from the second camera of all that both see, unit frame.
std::vector<Vector3d> CommonDirections(const UnitProblem& pair) {
    std::vector<Vector3d> directions;
    const auto add = [&](const Eigen::Vector2d& at_px) {
        const auto ray = pair.cameras[1].model.Unproject(at_px);
        if (ray) directions.push_back(pair.cameras[1].pose->T_unit_camera.linear() * *ray);
    };
    for (const FarMatch& match : pair.far_matches) add(match.second_px);
    for (const Sighting& sighting : pair.sightings) {
        if (sighting.camera != 1) continue;
        for (const SeenCorner& corner : sighting.corners) add(corner.at_px);
    }
    return directions;
}

Matrix3d Shown(const std::vector<Vector3d>& directions) {
    Matrix3d sum = Matrix3d::Zero();
    for (const Vector3d& d : directions) sum += Matrix3d::Identity() - d * d.transpose();
    return sum / static_cast<double>(directions.size());
}

}  // namespace

double PairTurn::Shift_rad(const Vector3d& turn) const {
    return std::sqrt(std::max(0.0, turn.dot(shown * turn)));
}

std::optional<PairTurn> MeasurePairTurn(const UnitProblem& problem, std::size_t first,
                                        std::size_t second) {
    const UnitProblem pair = PairProblem(problem, first, second);
    if (pair.sightings.empty() && pair.far_matches.size() < kFewestFarMatches) return std::nullopt;
    const CameraGraph graph = BuildCameraGraph(pair);
    auto places = Start(pair, graph);
    if (!places) return std::nullopt;
    const KeptCorners kept = AllCorners(pair, graph);
    if (!UnitAdjustment(pair, graph, kept, {.robust = true}, *places).Solve()) return std::nullopt;
    const Matrix3d turn = places->T_unit_camera[1].linear() *
                          pair.cameras[1].pose->T_unit_camera.linear().transpose();
    const Eigen::AngleAxisd axis(turn);
    return PairTurn{.first = first,
                    .second = second,
                    .turn_rad = axis.angle() * axis.axis(),
                    .shown = Shown(CommonDirections(pair)),
                    .far_matches = pair.far_matches.size(),
                    .boards = SharedMoments(problem, first, second).size()};
}

std::vector<PairTurn> MeasurePairTurns(const UnitProblem& problem) {
    std::vector<PairTurn> turns;
    for (std::size_t first = 0; first < problem.cameras.size(); ++first) {
        for (std::size_t second = first + 1; second < problem.cameras.size(); ++second) {
            if (const auto turn = MeasurePairTurn(problem, first, second)) turns.push_back(*turn);
        }
    }
    return turns;
}

}  // namespace hitchview::calib
