#pragma once

#include "algo/camera_model.hpp"

namespace hitchview::calib {

/// Largest angle from the optical axis, rad, up to which the distortion grows in every direction
/// and beyond which the picture sees nothing: what `max_theta_rad` of a lens is that comes without
/// one. `model.max_theta_rad` is not looked at. 0: the distortion grows nowhere.
double WidestField(const algo::CameraModel& model);

}  // namespace hitchview::calib
