#pragma once

#include <atomic>
#include <cstdint>
#include <mutex>

#include "hal/blocking_ring.hpp"
#include "hal/can_bus.hpp"

namespace hitchview::drivers {

/// The CAN bus of a recording: whoever reads the recording puts its frames in. Frames that find no
/// room are counted as dropped: the reader never waits for who listens to the bus.
/// Thread: one appends, one other calls WaitFrame.
class LcmLogCanBus final : public hal::CanBus {
 public:
    static constexpr std::size_t kMostWaiting = 4096;

    void Append(const hal::CanFrame& frame) {
        if (frame.kind == hal::CanFrameKind::kError) ++errors_;
        if (!frames_.TryAppend(frame)) ++dropped_;
    }
    /// No further frame will come.
    void Close() { frames_.Close(); }

 private:
    hal::Result<hal::CanFrame> DoWaitFrame(std::chrono::milliseconds timeout) override {
        const auto frame = frames_.TakeFor(timeout);
        if (!frame) return frames_.finished() ? hal::Error::kEndOfStream : hal::Error::kTimeout;
        ++delivered_;
        return *frame;
    }
    [[nodiscard]] hal::CanCounts DoCounts() const override {
        return {.delivered = delivered_, .dropped = dropped_, .errors = errors_};
    }

    hal::BlockingRing<hal::CanFrame, kMostWaiting> frames_;
    std::atomic<std::uint64_t> delivered_{0};
    std::atomic<std::uint64_t> dropped_{0};
    std::atomic<std::uint64_t> errors_{0};
};

}  // namespace hitchview::drivers
