#pragma once

#include <optional>

#include "calib/hitch_solver.hpp"

namespace hitchview::calib {

/// Everything that is solved for. World: the tractor in the first shot.
struct HitchPlaces {
    std::vector<std::string> shots{};                  ///< those that show both units
    std::vector<Eigen::Isometry3d> T_world_tractor{};  ///< of each shot
    std::vector<Eigen::Matrix3d> R_tractor_trailer{};  ///< of each shot
    std::vector<Eigen::Isometry3d> T_world_target{};   ///< of each target
    std::vector<bool> target_is_placed{};
    /// Hitch point in the frame of the tractor, then of the trailer.
    Eigen::Matrix<double, 6, 1> hitch = Eigen::Matrix<double, 6, 1>::Zero();
};

/// Where everything roughly is: units and targets placed along the sightings, then the point that
/// moves least in both units (linear least squares). Empty: fewer than two shots show both units in
/// one world.
std::optional<HitchPlaces> FirstHitch(const HitchProblem& problem);

}  // namespace hitchview::calib
