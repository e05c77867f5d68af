#include "calib/pair_turn.hpp"

#include <algorithm>
#include <cmath>
#include <set>
#include <utility>

#include "calib/camera_graph.hpp"
#include "calib/far_matches.hpp"
#include "calib/lens_solver.hpp"
#include "calib/median.hpp"
#include "calib/reprojection_error.hpp"
#include "calib/unit_adjustment.hpp"

namespace hitchview::calib {
namespace {

using Eigen::Isometry3d;
using Eigen::Matrix3d;
using Eigen::Vector3d;

constexpr std::size_t kFewestFarMatches = 8;
/// Rays farther apart than this do not meet: half a pixel of a 120-degree camera.
constexpr double kApart_rad = 0.001;

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

void AddFar(const UnitProblem& pair, std::vector<CommonSight>& sights) {
    const auto& cameras = pair.cameras;
    for (const FarMatch& match : pair.far_matches) {
        const auto first = cameras[0].model.Unproject(match.first_px);
        const auto second = cameras[1].model.Unproject(match.second_px);
        if (!first || !second) continue;
        sights.push_back({cameras[0].pose->T_unit_camera.linear() * *first,
                          cameras[1].pose->T_unit_camera.linear() * *second});
    }
}

/// `places`: boards as the first camera sees them.
void AddBoards(const UnitProblem& pair, const CameraGraph& graph, const UnitPlaces& places,
               std::vector<CommonSight>& sights) {
    const Vector3d first_m = pair.cameras[0].pose->T_unit_camera.translation();
    const Isometry3d& second = pair.cameras[1].pose->T_unit_camera;
    for (std::size_t i = 0; i < pair.sightings.size(); ++i) {
        const Sighting& sighting = pair.sightings[i];
        if (sighting.camera != 1 || !graph.node_of[i]) continue;
        const Isometry3d& T_unit_board = places.T_unit_target[*graph.node_of[i]];
        for (const SeenCorner& corner : sighting.corners) {
            const auto ray = pair.cameras[1].model.Unproject(corner.at_px);
            if (!ray) continue;
            const Vector3d to_corner =
                T_unit_board * pair.targets[sighting.target].board.Corner(corner.index) - first_m;
            sights.push_back({to_corner.normalized(), second.linear() * *ray, to_corner.norm()});
        }
    }
}

/// Angle between the two rays to each thing.
std::vector<double> Angles(const PairTurn& pair, const Matrix3d& first_turn,
                           const Matrix3d& second_turn) {
    std::vector<double> angles_rad;
    for (const CommonSight& sight : pair.sights) {
        const Vector3d first = first_turn * sight.from_first;
        const Vector3d second = second_turn * sight.from_second;
        if (sight.distance_m) {
            const Vector3d expected = first * *sight.distance_m + pair.baseline_m;
            angles_rad.push_back(std::atan2(expected.cross(second).norm(), expected.dot(second)));
        } else {
            angles_rad.push_back(AngleAtBestDistance(first, second, pair.baseline_m).angle_rad);
        }
    }
    return angles_rad;
}

}  // namespace

double PairTurn::OffShare(const Matrix3d& first_turn, const Matrix3d& second_turn) const {
    const std::vector<double> angles_rad = Angles(*this, first_turn, second_turn);
    const auto off =
        std::ranges::count_if(angles_rad, [](double angle_rad) { return angle_rad > kApart_rad; });
    return static_cast<double>(off) / static_cast<double>(angles_rad.size());
}

double PairTurn::Misalignment_rad() const {
    const Matrix3d still = Matrix3d::Identity();
    double shift_rad = 0;
    for (const CommonSight& sight : sights)
        shift_rad += turn_rad.cross(sight.from_second).norm() / static_cast<double>(sights.size());
    return std::max(Median(Angles(*this, still, still)), shift_rad);
}

std::optional<PairTurn> MeasurePairTurn(const UnitProblem& problem, std::size_t first,
                                        std::size_t second) {
    const UnitProblem pair = PairProblem(problem, first, second);
    if (pair.sightings.empty() && pair.far_matches.size() < kFewestFarMatches) return std::nullopt;
    const CameraGraph graph = BuildCameraGraph(pair);
    auto places = Start(pair, graph);
    if (!places) return std::nullopt;
    PairTurn result{.first = first,
                    .second = second,
                    .baseline_m = pair.cameras[0].pose->T_unit_camera.translation() -
                                  pair.cameras[1].pose->T_unit_camera.translation(),
                    .boards = SharedMoments(problem, first, second).size()};
    AddFar(pair, result.sights);
    AddBoards(pair, graph, *places, result.sights);
    if (result.sights.empty()) return std::nullopt;
    const KeptCorners kept = AllCorners(pair, graph);
    if (!UnitAdjustment(pair, graph, kept, {.robust = true}, *places).Solve()) return std::nullopt;
    const Matrix3d turn = places->T_unit_camera[1].linear() *
                          pair.cameras[1].pose->T_unit_camera.linear().transpose();
    const Matrix3d still = Matrix3d::Identity();
    if (result.OffShare(still, still) - result.OffShare(still, turn) >= PairTurn::kClearly) {
        const Eigen::AngleAxisd axis(turn);
        result.turn_rad = axis.angle() * axis.axis();
    }
    return result;
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
