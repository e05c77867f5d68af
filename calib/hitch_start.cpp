#include "calib/hitch_start.hpp"

#include <Eigen/Cholesky>
#include <algorithm>
#include <set>

#include "calib/pose_graph.hpp"

namespace hitchview::calib {
namespace {

using Eigen::Isometry3d;
using Eigen::Matrix3d;
using Eigen::Vector3d;

std::vector<std::string> Shots(const HitchProblem& problem) {
    std::set<std::string> shots;
    for (const Sighting& sighting : problem.sightings) shots.insert(sighting.shot);
    return {shots.begin(), shots.end()};
}

/// Bodies: the tractor and the trailer of each shot in turn.
PoseGraph GraphOf(const HitchProblem& problem, const std::vector<std::string>& shots) {
    constexpr std::size_t kFewestCorners = 6;
    PoseGraph graph;
    graph.bodies.resize(2 * shots.size());
    graph.targets.resize(problem.targets.size());
    for (const Sighting& sighting : problem.sightings) {
        if (sighting.corners.size() < kFewestCorners) continue;
        const CalibratedCamera& camera = problem.cameras[sighting.camera];
        const auto shot = std::ranges::find(shots, sighting.shot) - shots.begin();
        graph.sightings.push_back(
            {.body = 2 * static_cast<std::size_t>(shot) + static_cast<std::size_t>(camera.unit),
             .target = sighting.target,
             .model = camera.model,
             .T_body_camera = camera.Geometry().T_unit_camera,
             .board_m = problem.targets[sighting.target].board.Corners(),
             .corners = sighting.corners});
    }
    return graph;
}

/// hitch_tractor = t + R hitch_trailer in each shot; a weak pull to the given height where the
/// shots leave it open.
Eigen::Matrix<double, 6, 1> FixedPoint(const std::vector<Isometry3d>& T_tractor_trailer,
                                       double height_m) {
    constexpr double kPull = 1e-3;
    Eigen::Matrix<double, 6, 6> normal = kPull * Eigen::Matrix<double, 6, 6>::Identity();
    Eigen::Matrix<double, 6, 1> right = Eigen::Matrix<double, 6, 1>::Zero();
    right[2] = right[5] = kPull * height_m;
    for (const Isometry3d& T : T_tractor_trailer) {
        Eigen::Matrix<double, 3, 6> equation;
        equation << Matrix3d::Identity(), -T.linear();
        normal += equation.transpose() * equation;
        right += equation.transpose() * T.translation();
    }
    return normal.ldlt().solve(right);
}

}  // namespace

std::optional<HitchPlaces> FirstHitch(const HitchProblem& problem) {
    const std::vector<std::string> shots = Shots(problem);
    if (shots.empty()) return std::nullopt;
    PoseGraph graph = GraphOf(problem, shots);
    graph.bodies[0] = Isometry3d::Identity();
    GrowPlaces(graph);
    HitchPlaces places;
    std::vector<Isometry3d> T_tractor_trailer;
    for (std::size_t i = 0; i < shots.size(); ++i) {
        const auto& tractor = graph.bodies[2 * i];
        const auto& trailer = graph.bodies[2 * i + 1];
        if (!tractor || !trailer) continue;
        places.shots.push_back(shots[i]);
        places.T_world_tractor.push_back(*tractor);
        T_tractor_trailer.push_back(tractor->inverse() * *trailer);
        places.R_tractor_trailer.push_back(T_tractor_trailer.back().linear());
    }
    if (places.shots.size() < 2) return std::nullopt;
    for (const auto& target : graph.targets) {
        places.target_is_placed.push_back(target.has_value());
        places.T_world_target.push_back(target.value_or(Isometry3d::Identity()));
    }
    places.hitch = FixedPoint(T_tractor_trailer, problem.height_m);
    return places;
}

}  // namespace hitchview::calib
