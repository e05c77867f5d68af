#pragma once

#include <Eigen/Geometry>
#include <optional>
#include <string>
#include <vector>

#include "calib/rig_calibration.hpp"
#include "calib/unit_problem.hpp"

namespace hitchview::calib {

/// Pictures of both units' cameras with the trailer turned this way and that. Targets stand still
/// while the vehicle moves between the shots; within a shot it is at rest.
struct HitchProblem {
    std::vector<std::string> names{};         ///< of the cameras
    std::vector<CalibratedCamera> cameras{};  ///< of both units
    std::vector<UnitTarget> targets{};        ///< none surveyed, none that moves
    std::vector<Sighting> sightings{};
    std::vector<std::string> straight{};  ///< shots in which the units were in line
    double height_m = 0;  ///< of the hitch point in the tractor's frame as it is now
};

/// How the trailer stood in one shot.
struct ShotArticulation {
    std::string shot{};
    double yaw_rad = 0;  ///< positive to the left; 0 in the straight shots, on average
    double sigma_rad = 0;
    double pitch_rad = 0;
    double roll_rad = 0;
};

/// Where the units turn against each other.
struct HitchSolution {
    /// The hitch point in the frames that the cameras' places were given in.
    Eigen::Vector3d hitch_tractor_m = Eigen::Vector3d::Zero();
    Eigen::Vector3d hitch_trailer_m = Eigen::Vector3d::Zero();
    Eigen::Vector3d sigma_tractor_m = Eigen::Vector3d::Zero();
    Eigen::Vector3d sigma_trailer_m = Eigen::Vector3d::Zero();
    /// Whether the pictures tell its height; otherwise it is the one that was given. A trailer that
    /// only yaws turns about a whole line.
    bool height_is_measured = false;
    double straight_rad = 0;  ///< yaw between the given frames when the units are in line
    std::optional<double> straight_sigma_rad{};  ///< empty: no straight shot, straight_rad is 0
    std::vector<ShotArticulation> shots{};
    /// Shots that are not used: no chain of targets links both units in them to the other shots.
    std::vector<std::string> loose_shots{};
    /// Indices of sightings of which fewer than half the corners fit.
    std::vector<std::size_t> outliers{};
    double sigma_px = 0;
    double rms_px = 0;  ///< of the corners that count
};

/// Joint least squares over places of the tractor, articulations (free turns that hardly roll or
/// pitch: 3 degrees), hitch point and targets; the cameras stay where they are in their units.
/// Robust first, then without corners that are more than 4.5 standard deviations off. Empty: no
/// shot shows both units linked by targets, or the pictures do not determine the hitch point.
std::optional<HitchSolution> SolveHitch(const HitchProblem& problem);

/// Why it may not be driven with, for a person. Empty: it may. Each of
///  - fewer than 3 shots, or articulations that spread over less than 20 degrees;
///  - no straight shot, or straight shots that are more than 0.25 degrees from their mean;
///  - a standard deviation over 5 mm along x or y or, of the straight yaw, over 0.05 degrees;
///  - a sighting of which fewer than half the corners fit: a target, or the vehicle, moved;
///  - corners that are off by more than 1 px (root mean square).
std::vector<std::string> JudgeHitch(const HitchProblem& problem, const HitchSolution& solution);

/// What it is judged by, for a file.
std::string HitchLimits();

/// The cameras with the origin of both frames in the hitch point, and the trailer's turned so that
/// the units are in line at yaw 0.
RigCalibration WithHitch(const RigCalibration& rig, const HitchSolution& solution);

}  // namespace hitchview::calib
