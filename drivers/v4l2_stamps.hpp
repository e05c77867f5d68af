#pragma once

#include <cstdint>
#include <optional>

#include "hal/frame.hpp"

namespace hitchview::drivers {

/// Which moment of a frame its time stamp names.
enum class V4l2StampSource : std::uint8_t {
    kStartOfExposure,
    kEndOfFrame,
    kDequeue,  ///< the driver does not stamp with CLOCK_MONOTONIC: when we took the frame
};

/// v4l2_buffer::flags, as far as they speak of the stamp.
V4l2StampSource StampSourceOf(std::uint32_t buffer_flags);

/// From a stamp to the start of exposure. A stamp of the start is taken as it is. A stamp of the
/// end, or of our dequeueing, is later by the exposure and by the read-out, which the kernel does
/// not tell: the exposure is subtracted where its control can be read, otherwise the frame
/// interval, which neither exceeds. The same shift for each frame of a stream: an error in it is
/// constant and does not disturb what is between frames.
hal::Instant ExposureStart(hal::Instant stamp, V4l2StampSource source,
                           std::optional<hal::Instant> maybe_exposure, hal::Instant period);

}  // namespace hitchview::drivers
