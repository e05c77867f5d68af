#pragma once

#include <array>
#include <cstdint>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "drivers/v4l2_device.hpp"
#include "hal/frame.hpp"
#include "hal/result.hpp"

namespace hitchview::drivers {

/// One setting of a device, as it describes it.
struct V4l2Control {
    std::uint32_t id = 0;
    std::string name;  ///< as v4l2-ctl writes it: exposure_time_absolute
    std::uint32_t type = 0;
    std::int64_t minimum = 0;
    std::int64_t maximum = 0;
    std::uint64_t step = 1;
    std::int64_t default_value = 0;
    std::uint32_t flags = 0;
    std::vector<std::pair<std::int64_t, std::string>> menu;  ///< index and text of each entry
};

enum class V4l2Menus : std::uint8_t { kListed, kLeftOut };

/// Every control that is not disabled, of drivers whose lists do not end at most 1024 controls and
/// menu entries. Set-up only. Menus may have holes, and the kernel is asked
/// for each entry: leave them out where they are not needed.
std::vector<V4l2Control> ListControls(const V4l2Device& device, V4l2Menus menus);

/// A control and its value as a person writes them. Name: v4l2-ctl's, the driver's own ("Exposure
/// Time, Absolute"), or the id (0x009a0902 or decimal). Value: a number, true or false, or the text
/// of a menu's entry.
struct V4l2ControlWish {
    std::string control;
    std::string value;
};

/// A value that has been checked, ready for the device.
struct V4l2ControlValue {
    std::uint32_t id = 0;
    std::int64_t value = 0;
    bool wide = false;  ///< 64 bits
};

/// In the order of the wishes: automatic exposure off comes before the exposure itself. The error
/// names control, value and what is allowed. Pure.
hal::Checked<std::vector<V4l2ControlValue>> PlanControls(
    const std::vector<V4l2Control>& controls, const std::vector<V4l2ControlWish>& wishes);

struct V4l2Orientation {
    int rotation_deg = 0;  ///< 0 or 180
    bool horizontal_flip = false;
    bool vertical_flip = false;
};

/// By the device's own mirrors: 180 degrees are both. A device that has them is always told; one
/// that lacks a mirror that is needed is an error, which says who has to turn the picture instead.
/// Pure.
hal::Checked<std::vector<V4l2ControlValue>> PlanOrientation(
    const std::vector<V4l2Control>& controls, const V4l2Orientation& orientation);

/// The orientation, then the wishes. Pure.
hal::Checked<std::vector<V4l2ControlValue>> PlanSettings(
    const std::vector<V4l2Control>& controls, const V4l2Orientation& orientation,
    const std::vector<V4l2ControlWish>& wishes);

/// The mirrors that a device has, and what they are to be set to.
struct V4l2Mirrors {
    std::array<V4l2ControlValue, 2> values{};
    std::size_t count = 0;
};

/// PlanOrientation for a device that comes while the program runs. kUnsupported: it lacks a mirror
/// that is needed. No memory from the heap.
V4l2Result<V4l2Mirrors> AskMirrors(const V4l2Device& device, const V4l2Orientation& orientation);

/// No memory from the heap.
V4l2Result<hal::Done> SetControl(const V4l2Device& device, const V4l2ControlValue& value);

/// V4L2_CID_EXPOSURE_ABSOLUTE can be read. Pure.
bool HasExposure(const std::vector<V4l2Control>& controls);
/// The same of a device that is asked for this control alone. No memory from the heap.
bool AskExposure(const V4l2Device& device);
/// Only of a device that HasExposure. No memory from the heap.
std::optional<hal::Instant> ReadExposure(const V4l2Device& device);

}  // namespace hitchview::drivers
