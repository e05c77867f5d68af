#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "drivers/v4l2_stamps.hpp"
#include "drivers/v4l2_controls.hpp"
#include "drivers/v4l2_kernel.hpp"
#include "drivers/v4l2_offers.hpp"

namespace hitchview::drivers {

/// What one video node is and can do.
struct V4l2DeviceReport {
    std::string path;                ///< /dev/video0
    std::vector<std::string> links;  ///< by which a configuration names it lastingly
    std::string driver;
    std::string card;
    std::string bus;
    bool multi_planar = false;
    std::vector<V4l2FormatOffer> offers;
    std::vector<V4l2Control> controls;
    /// Known only of a device that nobody streams from.
    bool stamps_known = false;
    V4l2StampSource stamps = V4l2StampSource::kEndOfFrame;
    std::string refusal;  ///< why nothing more is known; empty otherwise
};

/// Every node /dev/video* that captures, by number; those that do not (outputs, metadata) are left
/// out. Changes no setting; a device in use is told of as far as it answers. Needs /dev/v4l for
/// links, which udev makes, and looks at the links of `link_folders` too. Set-up only.
std::vector<V4l2DeviceReport> ProbeV4l2Devices(
    const std::vector<std::string>& link_folders = {"/dev/v4l/by-path", "/dev/v4l/by-id",
                                                    "/dev/hitchview"},
    V4l2Kernel& kernel = SystemKernel());

}  // namespace hitchview::drivers
