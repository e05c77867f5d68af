#pragma once

#include <span>
#include <vector>

#include "calib/unit_problem.hpp"

namespace hitchview::calib {

/// The matches of one pair of cameras that one small turn of the second camera explains, each with
/// a distance of its own from 10 m to infinity: the largest such set over many turns that two
/// matches suggest (Fischler and Bolles, 1981, with a fixed order instead of chance). Empty where
/// too few agree for that not to be by chance.
std::vector<FarMatch> AgreeingMatches(const std::vector<FarMatch>& matches,
                                      const std::vector<UnitCamera>& cameras,
                                      std::span<const Eigen::Isometry3d> T_unit_camera);

}  // namespace hitchview::calib
