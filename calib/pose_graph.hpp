#pragma once

#include <Eigen/Geometry>
#include <optional>
#include <vector>

#include "algo/camera_model.hpp"
#include "calib/board.hpp"

namespace hitchview::calib {

/// A board that a camera of a rigid body sees.
struct BodySighting {
    std::size_t body = 0;
    std::size_t target = 0;
    algo::CameraModel model{};
    Eigen::Isometry3d T_body_camera = Eigen::Isometry3d::Identity();
    std::vector<Eigen::Vector3d> board_m{};
    SeenCorners corners{};
};

/// Rigid bodies with cameras, and boards. Places are T_world_body and T_world_board.
struct PoseGraph {
    using Places = std::vector<std::optional<Eigen::Isometry3d>>;

    std::vector<BodySighting> sightings{};
    Places bodies{};   ///< those that are known
    Places targets{};  ///< those that are known; they stay as they are
    /// Of bodies, to be used where nothing else leads to one; as many as bodies.
    Places fallbacks{};
};

/// Gives a place to whatever sees or is seen by something that has one, the most certain first. A
/// flat board has two places that look nearly alike in one picture: the one that fits all other
/// sightings better is taken. What hangs on nothing stays without.
void GrowPlaces(PoseGraph& graph);

}  // namespace hitchview::calib
