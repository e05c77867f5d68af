#include "drivers/v4l2_accounting.hpp"

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

hal::Result<hal::FrameHeader> V4l2Accounting::Accept(std::uint32_t device_sequence,
                                                     hal::Instant stamp, bool damaged) {
    const Seen seen{device_sequence, stamp};
    const bool steps_back = maybe_last_ && stamp < maybe_last_->stamp;
    if (maybe_last_) sequence_ += NoteGaps(*maybe_last_, seen);
    maybe_last_ = seen;
    const hal::FrameHeader header{sequence_++, stamp};
    if (!damaged && !steps_back) return header;
    NoteCorrupted();
    return hal::Error::kCorrupted;
}

std::uint32_t V4l2Accounting::NoteGaps(const Seen& early, const Seen& late) {
    // A device that does not number its frames, or starts again, steps by nothing or backwards.
    const auto step = static_cast<std::int32_t>(late.device_sequence - early.device_sequence);
    if (step > 1) {
        lost_ += static_cast<std::uint64_t>(step - 1);
        return static_cast<std::uint32_t>(step - 1);
    }
    const hal::Instant elapsed = late.stamp - early.stamp;
    if (2 * elapsed <= 3 * period_) return 0;
    const auto missing = static_cast<std::uint32_t>((elapsed + period_ / 2) / period_ - 1);
    lost_unnumbered_ += missing;
    return step == 1 ? 0 : missing;
}

hal::CameraCounts V4l2Accounting::counts() const {
    return {delivered_, lost_, corrupted_, lost_unnumbered_, reopened_};
}

}  // namespace hitchview::drivers
