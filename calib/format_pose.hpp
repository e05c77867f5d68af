#pragma once

#include <Eigen/Geometry>
#include <optional>
#include <string>

#include "calib/yaml_map.hpp"

namespace hitchview::calib {

/// A rigid motion from a 4x4 matrix; empty with a complaint.
std::optional<Eigen::Isometry3d> ReadMatrixPose(const YamlValue& value);

/// A rigid motion from mrcal's rt: Rodrigues' vector, then the translation; empty with a complaint.
std::optional<Eigen::Isometry3d> ReadRtPose(const YamlValue& value);

/// Rows of the matrix, each on a line behind `line_start`.
std::string MatrixPoseText(const Eigen::Isometry3d& pose, const std::string& line_start);

/// `[r0, r1, r2, t0, t1, t2]`.
std::string RtPoseText(const Eigen::Isometry3d& pose);

}  // namespace hitchview::calib
