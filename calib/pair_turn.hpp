#pragma once

#include <Eigen/Core>
#include <cstddef>
#include <optional>
#include <vector>

#include "calib/unit_problem.hpp"

namespace hitchview::calib {

/// How two cameras of a unit stand to each other in fresh pictures, against their calibration.
struct PairTurn {
    std::size_t first = 0;
    std::size_t second = 0;
    /// Of the second camera while the first stays; rotation vector in the unit frame, rad.
    Eigen::Vector3d turn_rad = Eigen::Vector3d::Zero();
    /// Mean of I - d d^T over the directions d in which both see the same: what of a turn shows.
    Eigen::Matrix3d shown = Eigen::Matrix3d::Zero();
    std::size_t far_matches = 0;
    std::size_t boards = 0;  ///< seen by both at the same moment

    /// Root mean square of what a turn shifts what both see, rad.
    [[nodiscard]] double Shift_rad(const Eigen::Vector3d& turn) const;
};

/// Fits turn and small shift of the second camera to the boards and far matches that both see.
/// `problem`: every camera has a measured pose, that of the calibration; every target moves. Empty
/// where both see too little in common: no board and fewer than eight far matches.
std::optional<PairTurn> MeasurePairTurn(const UnitProblem& problem, std::size_t first,
                                        std::size_t second);

/// Of all pairs that see enough in common.
std::vector<PairTurn> MeasurePairTurns(const UnitProblem& problem);

}  // namespace hitchview::calib
