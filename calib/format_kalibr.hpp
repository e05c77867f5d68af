#pragma once

#include "calib/format_lens.hpp"

namespace hitchview::calib {

/// The cameras of a camchain, and whether their places are those in the first camera's frame: where
/// no camera has T_cam_imu, whose "imu" is taken for the unit.
ForeignCameras ReadKalibr(YamlMap& root, const ImportHints& hints);

/// A camchain of cameras of one unit. The error: kalibr has no k3.
struct CamchainText {
    std::string text{};
    std::string error{};
};
CamchainText KalibrText(const std::vector<ForeignCamera>& cameras);

}  // namespace hitchview::calib
