#pragma once

#include <string>
#include <vector>

#include "app/camera_device.hpp"

namespace hitchview::app {

/// One live camera of a rig file, and the device that it names.
struct CameraMatch {
    algo::Unit unit = algo::Unit::kTractor;
    std::string name{};
    std::string configured{};  ///< path in the rig file
    std::string device{};      ///< path of the device that it leads to; empty: missing
    std::string problem{};     ///< why it cannot be used; empty: it can
    bool looked_for = true;    ///< false: libcamera's, which is no single device
};

/// What the rig asks of its V4L2 cameras; empty if it has none.
std::vector<CameraWish> WishesOf(const RigConfig& rig);

/// The live cameras of `rig` in its order. `devices`: probed with its wishes. A device in use is no
/// problem: the program that uses it may be the one that the rig file is for.
std::vector<CameraMatch> MatchCameras(const RigConfig& rig,
                                      const std::vector<CameraDevice>& devices);

/// Every camera that was looked for is there and can give what the rig asks of it.
bool AllThere(const std::vector<CameraMatch>& matches);

}  // namespace hitchview::app
