#pragma once

#include <cstdint>
#include <optional>

#include "drivers/v4l2_device.hpp"
#include "drivers/v4l2_format.hpp"
#include "hal/frame.hpp"

namespace hitchview::drivers {

/// What a device is told before it streams, and what it answers. Nothing here takes memory from the
/// heap: the same is said again when a device comes back.

/// What is known of the input that the pictures come from.
struct V4l2Input {
    bool has_timings = false;  ///< HDMI and the like: the source decides the size
    bool may_change = false;   ///< the device can tell that the source has changed
};

/// Selects an input; -1: the one that is selected. A device without inputs is one camera.
V4l2Result<V4l2Input> SelectInput(const V4l2Device& device, int input);

/// Takes over the timings of the source that is plugged in. kNotFound: there is no signal, or none
/// that can be shown. Only for an input that has_timings.
V4l2Result<hal::Done> FollowTimings(const V4l2Device& device);

/// V4L2_EVENT_SOURCE_CHANGE. Only for an input that may_change.
V4l2Result<hal::Done> SubscribeSourceChange(const V4l2Device& device);

/// Takes every event that waits. True if the source has changed its resolution.
bool TakeSourceChange(const V4l2Device& device);

struct V4l2FormatRequest {
    std::uint32_t fourcc = 0;
    int width_px = 0;
    int height_px = 0;
    int line_bytes = 0;  ///< from line to line at least; 0: the driver's own
};

/// What the driver made of it, which may be something else.
V4l2Result<V4l2Layout> SetFormat(const V4l2Device& device, const V4l2FormatRequest& request);

/// The rate that the driver made of it; empty where the device has no such setting.
V4l2Result<std::optional<double>> SetRate(const V4l2Device& device, double rate_hz);

V4l2Result<hal::Done> StartStream(const V4l2Device& device);
V4l2Result<hal::Done> StopStream(const V4l2Device& device);

}  // namespace hitchview::drivers
