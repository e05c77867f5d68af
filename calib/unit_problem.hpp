#pragma once

#include <Eigen/Geometry>
#include <cstddef>
#include <optional>
#include <string>
#include <vector>

#include "algo/camera_model.hpp"
#include "calib/board.hpp"

namespace hitchview::calib {

/// Where a camera stands as somebody has measured it, with a tape perhaps.
struct MeasuredPose {
    Eigen::Isometry3d T_unit_camera = Eigen::Isometry3d::Identity();
    double sigma_m = 0.02;     ///< of each coordinate
    double sigma_rad = 0.035;  ///< about each axis
};

/// A camera of a unit whose lens is known.
struct UnitCamera {
    std::string name{};
    algo::CameraModel model{};
    double yaw_rad = 0;  ///< rough direction in which it looks, 0 forward, positive to the left
    std::optional<MeasuredPose> pose{};
};

/// A point of a target's printed pattern that was measured in the unit frame.
struct SurveyedCorner {
    Eigen::Vector3d p_board_m = Eigen::Vector3d::Zero();
    Eigen::Vector3d p_unit_m = Eigen::Vector3d::Zero();
};

/// A board that stands somewhere round the vehicle.
struct UnitTarget {
    std::string name{};
    Board board{};
    bool moves = false;  ///< stands at a new place in each shot; at one place in all of them if not
    std::vector<SurveyedCorner> surveyed{};  ///< of one that does not move
    double sigma_m = 0.003;                  ///< of each coordinate of a surveyed corner
};

/// One target in one picture.
struct Sighting {
    std::size_t camera = 0;
    std::size_t target = 0;
    std::string
        shot{};  ///< stem of the picture's file; shots were taken in the order of their names
    SeenCorners corners{};
};

/// Something far away, at least 10 m, in pictures of two cameras of the same moment.
struct FarMatch {
    std::size_t first = 0;
    std::size_t second = 0;
    Eigen::Vector2d first_px = Eigen::Vector2d::Zero();
    Eigen::Vector2d second_px = Eigen::Vector2d::Zero();
};

/// What is known of where the cameras of one unit stand. The vehicle did not move meanwhile.
struct UnitProblem {
    std::vector<UnitCamera> cameras{};
    std::vector<UnitTarget> targets{};
    std::vector<Sighting> sightings{};
    std::vector<FarMatch> far_matches{};
};

}  // namespace hitchview::calib
