#pragma once

#include <Eigen/Geometry>
#include <opencv2/core.hpp>
#include <optional>
#include <span>
#include <vector>

#include "calib/unit_problem.hpp"

namespace hitchview::calib {

/// What two cameras of a unit both see far away, for every two that look at the same things.
/// `pictures`: grey, of each camera, of one moment; `T_unit_camera`: roughly known, to a degree.
/// Both pictures are redrawn as a camera between the two would see a scene far away, so that the
/// distortion of the lenses is out of the way; SIFT features (Lowe, 2004) are matched there, each
/// with the best one that is clearly better than the second best, in both directions, and not
/// farther apart than something 10 m away could be; of these, those that agree (see
/// AgreeingMatches).
std::vector<FarMatch> FindFarMatches(const std::vector<UnitCamera>& cameras,
                                     std::span<const Eigen::Isometry3d> T_unit_camera,
                                     std::span<const cv::Mat> pictures);

/// How two cameras see one thing at the distance that suits both best.
struct BestDistance {
    double inverse_m = 0;  ///< [0, 0.1]: 10 m and more
    double angle_rad = 0;  ///< that is left between the two rays
};

/// Of unit-length rays in the unit frame; `baseline_m`: from the second camera to the first.
BestDistance AngleAtBestDistance(const Eigen::Vector3d& first, const Eigen::Vector3d& second,
                                 const Eigen::Vector3d& baseline_m);

/// Inverse of the distance from 10 m on at which the rays of a match come nearest to each other,
/// [0, 0.1]; empty where a lens has no ray. `angle_rad`: what is between them then.
std::optional<double> BestInverseDistance(const FarMatch& match, const UnitProblem& problem,
                                          std::span<const Eigen::Isometry3d> T_unit_camera,
                                          double& angle_rad);

/// How well two neighbours agree on where things far away are.
struct NeighbourMisalignment {
    std::size_t first = 0;
    std::size_t second = 0;
    std::size_t matches = 0;
    /// Median angle between the two rays of a match, less what a distance of 10 m or more explains.
    double median_rad = 0;
};

/// Of every two cameras that have matches.
std::vector<NeighbourMisalignment> Misalignments(const UnitProblem& problem,
                                                 std::span<const Eigen::Isometry3d> T_unit_camera);

}  // namespace hitchview::calib
