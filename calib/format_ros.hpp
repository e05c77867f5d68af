#pragma once

#include "calib/format_lens.hpp"

namespace hitchview::calib {

/// ROS's camera_info, as a calibration file or as the printed message. `name`: of the camera where
/// the file gives none.
std::vector<ForeignCamera> ReadRos(YamlMap& root, const ImportHints& hints,
                                   const std::string& name);

std::string RosText(const std::string& name, const algo::CameraModel& model);

}  // namespace hitchview::calib
