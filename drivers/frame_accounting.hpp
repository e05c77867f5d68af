#pragma once

#include <atomic>
#include <cstdint>
#include <optional>

#include "hal/camera.hpp"
#include "hal/frame.hpp"

namespace hitchview::drivers {

/// Keeps the book of one camera's frames: what came, what is missing, what cannot be. Thread: the
/// one that takes frames; counts: any.
class FrameAccounting {
 public:
    /// `period`: nominal, > 0.
    explicit FrameAccounting(hal::Instant period) : period_(period) {}

    /// A stream starts, anew or again: the device counts from wherever it likes. What it numbers
    /// first follows the last frame of before without a gap.
    void Restart() {
        maybe_last_ = {};
        numbers_ = false;
    }
    void NoteReopened() { ++reopened_; }

    /// A frame left the device. kCorrupted, and so counted: it is marked as `damaged`, or its stamp
    /// is earlier than that of the frame before; frames after it are measured against it, or, if it
    /// is damaged, against the moment at which it was due.
    /// Sequence numbers may wrap. A step of the stamps of more than 1.5 periods between neighbours
    /// in sequence is frames that nobody numbered; in the sequence given out they are a gap only
    /// where the device does not number its frames at all. Of one that has counted, and then stays
    /// at a number, the number given out stays, too.
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
    bool numbers_ = false;  ///< the device has counted in this stream
    std::uint32_t sequence_ = 0;  ///< of the next frame without a gap
    std::atomic<std::uint64_t> delivered_ = 0;
    std::atomic<std::uint64_t> lost_ = 0;
    std::atomic<std::uint64_t> corrupted_ = 0;
    std::atomic<std::uint64_t> lost_unnumbered_ = 0;
    std::atomic<std::uint64_t> reopened_ = 0;
};

}  // namespace hitchview::drivers
