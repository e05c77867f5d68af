#pragma once

#include <Eigen/Core>
#include <Eigen/Geometry>
#include <cstddef>
#include <optional>
#include <vector>

#include "calib/unit_problem.hpp"

namespace hitchview::calib {

/// What two cameras both see of one thing, in the unit frame as calibrated.
struct CommonSight {
    Eigen::Vector3d from_first;   ///< of unit length
    Eigen::Vector3d from_second;  ///< of unit length
    /// From the first camera; of a corner of a board, which tells it. Empty: 10 m or more.
    std::optional<double> distance_m{};
};

/// How two cameras of a unit stand to each other in fresh pictures, against their calibration.
struct PairTurn {
    std::size_t first = 0;
    std::size_t second = 0;
    Eigen::Vector3d baseline_m = Eigen::Vector3d::Zero();  ///< second to first, unit frame
    std::vector<CommonSight> sights{};
    std::size_t boards = 0;  ///< seen by both at the same moment
    /// Of the second camera while the first stays; rotation vector in the unit frame, rad. 0 unless
    /// it explains clearly more sights than none does.
    Eigen::Vector3d turn_rad = Eigen::Vector3d::Zero();

    /// A share that is so much larger is clearly larger.
    static constexpr double kClearly = 0.1;

    /// Share of the sights whose rays do not meet, at any distance where it is not known, when the
    /// cameras are turned from how they were calibrated. A wrong turn looks like other distances of
    /// most things: those far away, whose rays would part, deny it.
    [[nodiscard]] double OffShare(const Eigen::Matrix3d& first_turn,
                                  const Eigen::Matrix3d& second_turn) const;
    /// How far apart both put what they see, rad: what the turn shifts it on average, at least the
    /// median angle that no distance explains.
    [[nodiscard]] double Misalignment_rad() const;
};

/// Fits turn and small shift of the second camera to the boards and far matches that both see.
/// `problem`: every camera has a measured pose, that of the calibration; every target moves. Empty
/// where both see too little in common: no board and fewer than eight far matches.
std::optional<PairTurn> MeasurePairTurn(const UnitProblem& problem, std::size_t first,
                                        std::size_t second);

/// Of all pairs that see enough in common.
std::vector<PairTurn> MeasurePairTurns(const UnitProblem& problem);

}  // namespace hitchview::calib
