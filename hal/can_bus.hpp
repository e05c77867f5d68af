#pragma once

#include <array>
#include <chrono>
#include <cstdint>

#include "hal/frame.hpp"
#include "hal/result.hpp"

namespace hitchview::hal {

enum class CanFrameKind : std::uint8_t {
    kData,
    kRemote,  ///< asks another node for `size_bytes` bytes; has none itself
    kError,   ///< made by the controller: `id` has the bits of the error classes
};

/// One frame of a classic or FD bus.
struct CanFrame {
    std::uint32_t id = 0;  ///< 11 or 29 bits, without flags
    bool extended = false;
    CanFrameKind kind = CanFrameKind::kData;  ///< others come only from a bus opened to record
    bool fd = false;                          ///< a data frame in the FD format
    std::uint8_t fd_flags = 0;    ///< FD: 1 bit rate switched, 2 sender passive, 4 always or never
    std::uint8_t size_bytes = 0;  ///< 0..8 classic, 0..64 FD
    std::array<std::uint8_t, 64> data{};
    Instant received_at{};
    /// The same moment as the wall clock showed it then, since 1970; 0: not known. For logs only:
    /// it may step.
    std::chrono::nanoseconds epoch{};

    bool operator==(const CanFrame&) const = default;
};

/// What became of a bus's frames since it was opened.
struct CanCounts {
    std::uint64_t delivered = 0;
    std::uint64_t dropped = 0;         ///< the kernel had no room for them
    std::uint64_t errors = 0;          ///< error frames
    std::uint64_t disconnections = 0;  ///< interface down, or controller bus-off
};

/// Frames received from one CAN bus. Thread: the one that calls WaitFrame.
class CanBus {
 public:
    virtual ~CanBus() = default;

    /// Blocks until a frame comes, at most `timeout` (> 0).
    /// kTimeout: the bus is silent; ordinary. kEndOfStream: the recording is over.
    /// kDisconnected: the interface is down or the controller is bus-off; call again, frames come
    /// once it is back.
    Result<CanFrame> WaitFrame(std::chrono::milliseconds timeout) {
        HV_EXPECT(timeout.count() > 0);
        return DoWaitFrame(timeout);
    }

    /// Any thread.
    [[nodiscard]] CanCounts counts() const { return DoCounts(); }

 private:
    virtual Result<CanFrame> DoWaitFrame(std::chrono::milliseconds timeout) = 0;
    [[nodiscard]] virtual CanCounts DoCounts() const { return {}; }
};

}  // namespace hitchview::hal
