#pragma once

#include <cstdint>
#include <span>
#include <string>
#include <vector>

#include "hal/result.hpp"

namespace hitchview::drivers {

/// Names of the rig's cameras in a hitchview.health_t, in the order of the bits of cameras_missing,
/// trusting nothing in it. kCorrupted: see ParseLoggedHealth; more than 8 cameras; a name that is
/// not printable ASCII of at most 63 letters.
hal::Result<std::vector<std::string>> ParseCameraNames(std::span<const std::uint8_t> message);

}  // namespace hitchview::drivers
