#include "drivers/frame_accounting.hpp"

namespace hitchview::drivers {

hal::Result<hal::FrameHeader> FrameAccounting::Accept(std::uint32_t device_sequence,
                                                      hal::Instant stamp, bool damaged) {
    Seen seen{device_sequence, stamp};
    const bool steps_back = maybe_last_ && stamp < maybe_last_->stamp;
    // A frame that a driver has given up may have no stamp at all.
    if (damaged && steps_back) seen.stamp = maybe_last_->stamp + period_;
    const bool is_stuck =
        numbers_ && !damaged && maybe_last_ && device_sequence == maybe_last_->device_sequence;
    if (maybe_last_) sequence_ += NoteGaps(*maybe_last_, seen);
    if (maybe_last_ || !damaged) maybe_last_ = seen;
    const hal::FrameHeader header{is_stuck ? sequence_ - 1 : sequence_++, stamp};
    if (!damaged && !steps_back) return header;
    NoteCorrupted();
    return hal::Error::kCorrupted;
}

std::uint32_t FrameAccounting::NoteGaps(const Seen& early, const Seen& late) {
    // A device that does not number its frames, or starts again, steps by nothing or backwards.
    const auto step = static_cast<std::int32_t>(late.device_sequence - early.device_sequence);
    numbers_ |= step == 1;
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

hal::CameraCounts FrameAccounting::counts() const {
    return {delivered_, lost_, corrupted_, lost_unnumbered_, reopened_};
}

}  // namespace hitchview::drivers
