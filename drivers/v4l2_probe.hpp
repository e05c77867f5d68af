#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "drivers/v4l2_controls.hpp"
#include "drivers/v4l2_kernel.hpp"
#include "drivers/v4l2_negotiation.hpp"
#include "drivers/v4l2_offers.hpp"
#include "drivers/v4l2_stamps.hpp"

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
    std::vector<std::string> inputs;  ///< names, by number; empty: there is no such choice
    bool busy = false;                ///< somebody streams from it
    /// Known only of a device that nobody streams from.
    bool stamps_known = false;
    V4l2StampSource stamps = V4l2StampSource::kEndOfFrame;
    std::string refusal;     ///< why nothing but `card` is known; empty otherwise
    int refusal_number = 0;  ///< its errno: EACCES
};

/// Where links to video nodes are made: by udev, and by its rules for a vehicle.
std::vector<std::string> V4l2LinkFolders();

/// Every node /dev/video* that captures, by number; those that do not (outputs, metadata) are left
/// out. Changes no setting; a device in use is told of as far as it answers. Links: those of
/// `link_folders`, in that order. `wanted`: see ListOffers. Set-up only.
std::vector<V4l2DeviceReport> ProbeV4l2Devices(
    const std::vector<std::string>& link_folders = V4l2LinkFolders(),
    V4l2Kernel& kernel = SystemKernel(), V4l2Size wanted = {1280, 720});

/// Whether input, orientation and controls can be set as `options` ask. The error names what cannot
/// be had, and what there is. Pure.
hal::Checked<hal::Done> CheckSettings(const V4l2DeviceReport& report,
                                      const V4l2CameraOptions& options);

}  // namespace hitchview::drivers
