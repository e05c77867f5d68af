#pragma once

#include <optional>
#include <vector>

#include "calib/unit_adjustment.hpp"

namespace hitchview::calib {

/// Where a camera stands, and how well that is known.
struct PlacedCamera {
    Eigen::Isometry3d T_unit_camera = Eigen::Isometry3d::Identity();
    /// Roll, pitch and yaw of the camera's body (docs/conventions.md), rad, and their standard
    /// deviations.
    Eigen::Vector3d rpy_rad = Eigen::Vector3d::Zero();
    Eigen::Vector3d rpy_sigma_rad = Eigen::Vector3d::Zero();
    Eigen::Vector3d position_sigma_m = Eigen::Vector3d::Zero();  ///< unit frame
    double rms_px = 0;                                           ///< of the corners that count
    std::size_t corners = 0;                                     ///< that count
};

/// What became of one sighting.
struct SightingOutcome {
    double rms_px = 0;     ///< of all its corners, also of those that do not count
    std::size_t kept = 0;  ///< corners that count
    bool outlier = false;  ///< fewer than half of its corners fit; of one that was used
};

/// Where everything stands.
struct UnitSolution {
    UnitPlaces places{};
    std::vector<PlacedCamera> cameras{};
    std::vector<SightingOutcome> sightings{};
    KeptCorners kept{};
    double sigma_px = 0;     ///< standard deviation of a corner's coordinate, as measured
    double prior_scale = 1;  ///< see UnitInformation
    /// Of all cameras' PlaceChange, in their order; for errors of the sizes that were found.
    Eigen::MatrixXd covariance{};
};

/// Solves robustly, leaves corners out that are more than 4.5 standard deviations off, and solves
/// again. Standard deviations are scaled by the errors that are left: those of corners are
/// measured, those of surveys believed unless what is left of them is larger. They do not know of
/// errors of the lenses. Empty: no places explain the sightings, or they determine not all of them.
/// `graph`: complete. Thread-safe, the same on every machine.
std::optional<UnitSolution> SolveUnit(const UnitProblem& problem, const CameraGraph& graph);

/// The same from places that are roughly known.
std::optional<UnitSolution> SolveUnitFrom(const UnitPlaces& start, const UnitProblem& problem,
                                          const CameraGraph& graph);

/// Distances of all corners of a sighting from where the places put them, px.
std::vector<double> CornerErrors(const UnitProblem& problem, const CameraGraph& graph,
                                 const UnitPlaces& places, std::size_t sighting);

/// Roll, pitch and yaw of a camera's body, rad.
Eigen::Vector3d RpyOf(const Eigen::Isometry3d& T_unit_camera);

}  // namespace hitchview::calib
