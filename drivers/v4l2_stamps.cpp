#include "drivers/v4l2_stamps.hpp"

#include <linux/videodev2.h>

#include <algorithm>

namespace hitchview::drivers {

V4l2StampSource StampSourceOf(std::uint32_t buffer_flags) {
    const std::uint32_t clock = buffer_flags & V4L2_BUF_FLAG_TIMESTAMP_MASK;
    if (clock != V4L2_BUF_FLAG_TIMESTAMP_MONOTONIC) return V4l2StampSource::kDequeue;
    const std::uint32_t source = buffer_flags & V4L2_BUF_FLAG_TSTAMP_SRC_MASK;
    return source == V4L2_BUF_FLAG_TSTAMP_SRC_SOE ? V4l2StampSource::kStartOfExposure
                                                  : V4l2StampSource::kEndOfFrame;
}

hal::Instant ExposureStart(hal::Instant stamp, V4l2StampSource source,
                           std::optional<hal::Instant> maybe_exposure, hal::Instant period) {
    if (source == V4l2StampSource::kStartOfExposure) return stamp;
    return stamp - std::min(maybe_exposure.value_or(period), period);
}

}  // namespace hitchview::drivers
