#include "drivers/looped_camera.hpp"

#include <algorithm>

#include "drivers/frame_slot.hpp"

namespace hitchview::drivers {

LoopedCamera::LoopedCamera(const LoopedFrames& frames, const LoopedCameraOptions& options)
    : frames_(frames), options_(options), pool_(frames.format(), options.slots) {}

hal::Result<hal::FrameLease> LoopedCamera::DoWaitFrame(std::chrono::milliseconds timeout) {
    if (next_frame_ >= options_.frames) return hal::Error::kEndOfStream;
    const auto bytes = frames_.Frame(options_.camera, next_frame_);
    if (bytes.empty()) {
        ++next_frame_;
        return hal::Error::kCorrupted;
    }
    const auto maybe_slot = WaitSlot(pool_, timeout);
    if (!maybe_slot) return hal::Error::kTimeout;
    std::ranges::copy(bytes, maybe_slot->bytes.begin());
    const std::uint32_t number = next_frame_++;
    return pool_.Lease(*maybe_slot, {.sequence = number,
                                     .captured_at = options_.start + number * options_.period});
}

LoopedLiveCamera::LoopedLiveCamera(const LoopedFrames& frames, const LoopedCameraOptions& options,
                                   hal::Clock& clock)
    : frames_(frames),
      options_(options),
      clock_(clock),
      pool_(frames.format(), options.slots),
      accounting_(options.period) {}

hal::Instant LoopedLiveCamera::MomentOf(std::uint64_t number) const {
    return options_.start + static_cast<std::int64_t>(number) * options_.period;
}

hal::Result<hal::FrameLease> LoopedLiveCamera::DoWaitFrame(std::chrono::milliseconds timeout) {
    const hal::Instant end = clock_.Now() + timeout;
    while (true) {
        TakeIn(clock_.Now());
        if (const auto maybe_frame = waiting_.Take()) return Lend(*maybe_frame);
        const hal::Instant next = MomentOf(next_frame_);
        clock_.SleepUntil(std::min(next, end));
        if (next > end) return hal::Error::kTimeout;
    }
}

void LoopedLiveCamera::TakeIn(hal::Instant now) {
    for (; MomentOf(next_frame_) <= now; ++next_frame_) {
        const auto maybe_slot = pool_.Take();
        if (!maybe_slot) continue;
        const auto bytes = frames_.Frame(options_.camera, next_frame_);
        std::ranges::copy(bytes, maybe_slot->bytes.begin());
        waiting_.Append({*maybe_slot, next_frame_, !bytes.empty()});
    }
}

hal::Result<hal::FrameLease> LoopedLiveCamera::Lend(const Waiting& frame) {
    const auto header = accounting_.Accept(static_cast<std::uint32_t>(frame.number),
                                           MomentOf(frame.number), !frame.given);
    if (!header) {
        pool_.Return(frame.slot);
        return header.error();
    }
    accounting_.NoteDelivered();
    return pool_.Lease(frame.slot, header.value());
}

hal::Result<hal::Done> LoopedLiveCamera::DoReopen() {
    while (const auto maybe_frame = waiting_.Take()) pool_.Return(maybe_frame->slot);
    const hal::Instant now = clock_.Now();
    while (MomentOf(next_frame_) <= now) ++next_frame_;
    accounting_.Restart();
    accounting_.NoteReopened();
    return hal::Done{};
}

}  // namespace hitchview::drivers
