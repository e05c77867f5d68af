#pragma once

#include <array>
#include <random>

#include "hal/can_bus.hpp"

namespace hitchview::tests {

/// Frames of every kind that a bus may carry, in a reproducible order.
class RandomCan {
 public:
    explicit RandomCan(unsigned seed) : random_(seed) {}

    hal::CanFrame Frame() {
        using hal::CanFrameKind;
        hal::CanFrame frame;
        const int kind = Up(9);
        frame.kind = kind == 0   ? CanFrameKind::kError
                     : kind == 1 ? CanFrameKind::kRemote
                                 : CanFrameKind::kData;
        frame.extended = frame.kind == CanFrameKind::kError || Up(1) == 1;
        frame.id = Bits() & (frame.extended ? 0x1fffffffU : 0x7ffU);
        frame.fd = frame.kind == CanFrameKind::kData && Up(2) == 0;
        if (frame.fd) frame.fd_flags = static_cast<std::uint8_t>(Up(3));
        constexpr std::array<std::uint8_t, 7> kFdSizes{12, 16, 20, 24, 32, 48, 64};
        frame.size_bytes = static_cast<std::uint8_t>(Up(8));
        if (frame.fd && Up(1) == 1) frame.size_bytes = kFdSizes[static_cast<std::size_t>(Up(6))];
        if (frame.kind == CanFrameKind::kError) frame.size_bytes = 8;
        if (frame.kind != CanFrameKind::kRemote) {
            for (int i = 0; i < frame.size_bytes; ++i)
                frame.data[i] = static_cast<std::uint8_t>(Up(255));
        }
        return frame;
    }

 private:
    int Up(int largest) { return std::uniform_int_distribution<int>(0, largest)(random_); }
    std::uint32_t Bits() { return static_cast<std::uint32_t>(random_()); }

    std::mt19937 random_;
};

}  // namespace hitchview::tests
