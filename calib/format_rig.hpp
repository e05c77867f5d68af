#pragma once

#include <Eigen/Geometry>
#include <optional>
#include <string>
#include <vector>

#include "algo/unit.hpp"
#include "calib/format.hpp"

namespace hitchview::calib {

/// The cameras of one file, and the unit that carries them.
struct UnitCameras {
    std::string file{};  ///< for complaints
    algo::Unit unit = algo::Unit::kTractor;
    ForeignCameras foreign{};
};

/// A rig calibration, unchecked and without provenance, or why it cannot be.
struct AssembledRig {
    std::optional<RigCalibration> calibration{};
    std::string error{};
};

/// Puts the cameras of files together. `T_unit_first`: where the first camera stands, from which
/// all others of the same frame of reference follow; without it the files' frame of reference is
/// the unit's. With it all files are of one unit.
AssembledRig AssembleRig(const std::vector<UnitCameras>& files, const std::string& vehicle,
                         const std::optional<Eigen::Isometry3d>& T_unit_first);

/// `X,Y,Z,ROLL,PITCH,YAW` in metres and degrees as T_unit_camera; empty: it is not six numbers in
/// range.
std::optional<Eigen::Isometry3d> ParseCameraPlace(std::string_view text);

}  // namespace hitchview::calib
