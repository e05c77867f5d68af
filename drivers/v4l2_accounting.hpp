#pragma once

#include <atomic>
#include <cstdint>
#include <optional>

#include "hal/camera.hpp"
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

/// Keeps the book of one camera's frames: what came, what is missing, what cannot be. Thread: the
/// one that takes frames; counts: any.
class V4l2Accounting {
 public:
    /// `period`: nominal, > 0.
    explicit V4l2Accounting(hal::Instant period) : period_(period) {}

    /// A stream starts, anew or again: the device counts from wherever it likes. What it numbers
    /// first follows the last frame of before without a gap.
    void Restart() { maybe_last_ = {}; }
    void NoteReopened() { ++reopened_; }

    /// A frame left the device. kCorrupted, and so counted: it is marked as `damaged`, or its stamp
    /// is earlier than that of the frame before; frames after it are measured against it.
    /// Sequence numbers may wrap. A step of the stamps of more than 1.5 periods between neighbours
    /// in sequence is frames that nobody numbered; in the sequence given out they are a gap only
    /// where the device does not number its frames at all.
    hal::Result<hal::FrameHeader> Accept(std::uint32_t device_sequence, hal::Instant stamp,
                                         bool damaged);
    void NoteDelivered() { ++delivered_; }
    void NoteCorrupted() { ++corrupted_; }
    /// There was no memory to hand a frame out in.
    void NoteLost() { ++lost_; }

    [[nodiscard]] hal::CameraCounts counts() const;

 private:
    struct Seen {
        std::uint32_t device_sequence;
        hal::Instant stamp;
    };

    /// By how much the sequence given out skips.
    std::uint32_t NoteGaps(const Seen& early, const Seen& late);

    hal::Instant period_;
    std::optional<Seen> maybe_last_;
    std::uint32_t sequence_ = 0;  ///< of the next frame without a gap
    std::atomic<std::uint64_t> delivered_ = 0;
    std::atomic<std::uint64_t> lost_ = 0;
    std::atomic<std::uint64_t> corrupted_ = 0;
    std::atomic<std::uint64_t> lost_unnumbered_ = 0;
    std::atomic<std::uint64_t> reopened_ = 0;
};

}  // namespace hitchview::drivers
