#pragma once

#include <linux/can.h>
#include <sys/socket.h>

#include <array>
#include <cstddef>
#include <cstdint>
#include <optional>
#include <span>

#include "drivers/socketcan_time.hpp"
#include "hal/can_bus.hpp"

namespace hitchview::drivers {

/// Room for one frame of a CAN socket with what the kernel says about it, used again for each.
class SocketCanMessage {
 public:
    SocketCanMessage();
    SocketCanMessage(const SocketCanMessage&) = delete;
    SocketCanMessage& operator=(const SocketCanMessage&) = delete;

    /// Does not wait. 0, or errno: EAGAIN when there is none, EBADMSG when it is no CAN frame.
    int Receive(int socket);
    /// The same of a frame and what is said about it that came in another way; at most as much as a
    /// socket gives is taken of each.
    int Take(std::span<const std::uint8_t> frame, std::span<const std::uint8_t> control);

    /// received_at is left open.
    [[nodiscard]] hal::CanFrame frame() const;
    [[nodiscard]] SocketCanStamps stamps() const;
    /// Frames that this socket had no room for until this one came, modulo 2^32; empty: none.
    [[nodiscard]] std::optional<std::uint32_t> dropped() const;

    [[nodiscard]] bool IsError() const { return (frame_.can_id & CAN_ERR_FLAG) != 0; }
    /// Error frames: the CAN_ERR_* classes of linux/can/error.h.
    [[nodiscard]] std::uint32_t error_classes() const { return frame_.can_id & CAN_ERR_MASK; }

 private:
    static constexpr std::size_t kControlBytes = 256;

    int Accept(std::size_t frame_bytes);
    [[nodiscard]] const cmsghdr* Find(int type, std::size_t bytes) const;

    canfd_frame frame_{};
    bool fd_ = false;
    iovec place_{};
    alignas(cmsghdr) std::array<std::byte, kControlBytes> control_{};
    msghdr header_{};
};

}  // namespace hitchview::drivers
