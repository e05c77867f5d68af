#pragma once

#include <algorithm>
#include <cstdint>
#include <deque>
#include <optional>
#include <utility>

#include "hal/camera.hpp"

namespace hitchview::hal {

/// A frame of one grey value in every byte.
struct FakeFrame {
    FrameHeader header;
    std::uint8_t fill = 128;
};

/// Plays a script, one step per WaitFrame, then kEndOfStream. kTimeout while all frames are lent.
class FakeCamera final : public Camera {
 public:
    FakeCamera(const FrameFormat& format, std::deque<Result<FakeFrame>> script, int slots = 4)
        : pool_(format, slots), script_(std::move(script)) {}

 private:
    [[nodiscard]] const FrameFormat& DoFormat() const override { return pool_.format(); }
    Result<FrameLease> DoWaitFrame(std::chrono::milliseconds /*timeout*/) override {
        if (script_.empty()) return Error::kEndOfStream;
        if (!script_.front()) return Play().error();
        const std::optional<FramePool::Slot> maybe_slot = pool_.Take();
        if (!maybe_slot) return Error::kTimeout;
        const FakeFrame frame = Play().value();
        std::ranges::fill(maybe_slot->bytes, frame.fill);
        return pool_.Lease(*maybe_slot, frame.header);
    }
    Result<FakeFrame> Play() {
        const Result<FakeFrame> step = script_.front();
        script_.pop_front();
        return step;
    }

    FramePool pool_;
    std::deque<Result<FakeFrame>> script_;
};

}  // namespace hitchview::hal
