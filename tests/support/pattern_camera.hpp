#pragma once

#include <cstdint>
#include <span>

#include "hal/camera.hpp"

namespace hitchview::tests {

/// Bytes that tell camera and frame.
inline void FillPattern(std::uint32_t camera, std::uint32_t sequence, std::span<std::uint8_t> out) {
    std::uint32_t state = 2'654'435'761U * (camera + 1) + 97 * sequence;
    for (std::uint8_t& byte : out)
        byte = static_cast<std::uint8_t>((state = state * 1'664'525U + 1'013'904'223U) >> 24);
}

/// A camera whose frame i, captured at i periods, has the bytes of FillPattern. kTimeout while all
/// frames are lent.
class PatternCamera final : public hal::Camera {
 public:
    PatternCamera(std::uint32_t camera, const hal::FrameFormat& format, hal::Instant period,
                  int slots = 10)
        : camera_(camera), period_(period), pool_(format, slots) {}

 private:
    [[nodiscard]] const hal::FrameFormat& DoFormat() const override { return pool_.format(); }
    hal::Result<hal::FrameLease> DoWaitFrame(std::chrono::milliseconds /*timeout*/) override {
        const auto slot = pool_.Take();
        if (!slot) return hal::Error::kTimeout;
        FillPattern(camera_, next_, slot->bytes);
        const hal::FrameHeader header{.sequence = next_, .captured_at = period_ * next_};
        ++next_;
        return pool_.Lease(*slot, header);
    }

    std::uint32_t camera_;
    hal::Instant period_;
    hal::FramePool pool_;
    std::uint32_t next_ = 0;
};

}  // namespace hitchview::tests
