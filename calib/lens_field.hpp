#pragma once

#include "algo/camera_model.hpp"

namespace hitchview::calib {

/// Angle from the optical axis of the farthest ray that has a pixel in the picture and an inverse,
/// rad: what CameraModel::max_theta_rad should be. The lens's own is not looked at. 0: its
/// distortion has no inverse anywhere.
double FieldOf(const algo::CameraModel& lens);

}  // namespace hitchview::calib
