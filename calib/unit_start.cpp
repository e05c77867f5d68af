#include "calib/unit_start.hpp"

#include "calib/pose_graph.hpp"

namespace hitchview::calib {
namespace {

using Eigen::Isometry3d;

/// From at least three corners that were surveyed.
Isometry3d SurveyedPlace(const UnitTarget& target) {
    Eigen::Matrix3Xd from(3, std::ssize(target.surveyed));
    Eigen::Matrix3Xd to(3, std::ssize(target.surveyed));
    for (int i = 0; i < from.cols(); ++i) {
        from.col(i) = target.surveyed[static_cast<std::size_t>(i)].p_board_m;
        to.col(i) = target.surveyed[static_cast<std::size_t>(i)].p_unit_m;
    }
    Isometry3d place;
    place.matrix() = Eigen::umeyama(from, to, false);
    return place;
}

PoseGraph GraphOf(const UnitProblem& problem, const CameraGraph& graph) {
    PoseGraph poses;
    poses.bodies.resize(problem.cameras.size());
    for (const UnitCamera& camera : problem.cameras) {
        auto& fallback = poses.fallbacks.emplace_back();
        if (camera.pose) fallback = camera.pose->T_unit_camera;
    }
    for (const TargetNode& node : graph.nodes) {
        const UnitTarget& target = problem.targets[node.target];
        auto& place = poses.targets.emplace_back();
        if (PlaceIsSurveyed(target)) place = SurveyedPlace(target);
    }
    for (std::size_t i = 0; i < problem.sightings.size(); ++i) {
        const Sighting& sighting = problem.sightings[i];
        if (!graph.node_of[i]) continue;
        poses.sightings.push_back({.body = sighting.camera,
                                   .target = *graph.node_of[i],
                                   .model = problem.cameras[sighting.camera].model,
                                   .board_m = problem.targets[sighting.target].board.Corners(),
                                   .corners = sighting.corners});
    }
    return poses;
}

}  // namespace

std::optional<UnitPlaces> FirstPlaces(const UnitProblem& problem, const CameraGraph& graph) {
    PoseGraph poses = GraphOf(problem, graph);
    GrowPlaces(poses);
    UnitPlaces result;
    for (const auto& camera : poses.bodies) {
        if (!camera) return std::nullopt;
        result.T_unit_camera.push_back(*camera);
    }
    for (const auto& target : poses.targets) {
        if (!target) return std::nullopt;
        result.T_unit_target.push_back(*target);
    }
    result.size.assign(problem.targets.size(), 1.0);
    return result;
}

}  // namespace hitchview::calib
