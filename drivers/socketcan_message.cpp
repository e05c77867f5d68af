#include "drivers/socketcan_message.hpp"

#include <linux/errqueue.h>

#include <algorithm>
#include <cerrno>
#include <cstring>

#include "drivers/frame_clock.hpp"

namespace hitchview::drivers {
namespace {

using hal::CanFrameKind;
using hal::Instant;

constexpr std::uint8_t kFdFlags = 0xf;

CanFrameKind KindOf(canid_t id) {
    if ((id & CAN_ERR_FLAG) != 0) return CanFrameKind::kError;
    return (id & CAN_RTR_FLAG) != 0 ? CanFrameKind::kRemote : CanFrameKind::kData;
}

// A stamp that was not taken is 0; one beyond the year 2100 is none either.
std::optional<Instant> Given(const timespec& time) {
    constexpr std::int64_t kMostSeconds = 4'102'444'800;
    const bool taken = time.tv_sec != 0 || time.tv_nsec != 0;
    const bool sound = time.tv_sec >= 0 && time.tv_sec < kMostSeconds && time.tv_nsec >= 0 &&
                       time.tv_nsec < 1'000'000'000;
    return taken && sound ? std::optional(InstantOf(time)) : std::nullopt;
}

}  // namespace

SocketCanMessage::SocketCanMessage() : place_{&frame_, sizeof frame_} {
    header_.msg_iov = &place_;
    header_.msg_iovlen = 1;
    header_.msg_control = control_.data();
}

int SocketCanMessage::Receive(int socket) {
    header_.msg_controllen = control_.size();
    const ssize_t bytes = recvmsg(socket, &header_, MSG_DONTWAIT);
    if (bytes < 0) {
        header_.msg_controllen = 0;
        return errno;
    }
    return Accept(static_cast<std::size_t>(bytes));
}

int SocketCanMessage::Take(std::span<const std::uint8_t> frame,
                           std::span<const std::uint8_t> control) {
    header_.msg_controllen = std::min(control.size(), control_.size());
    std::ranges::copy(std::as_bytes(control).first(header_.msg_controllen), control_.begin());
    std::ranges::copy(std::as_bytes(frame).first(std::min(frame.size(), sizeof frame_)),
                      reinterpret_cast<std::byte*>(&frame_));
    return Accept(frame.size());
}

int SocketCanMessage::Accept(std::size_t frame_bytes) {
    fd_ = frame_bytes == CANFD_MTU;
    return fd_ || frame_bytes == CAN_MTU ? 0 : EBADMSG;
}

hal::CanFrame SocketCanMessage::frame() const {
    hal::CanFrame frame;
    frame.kind = KindOf(frame_.can_id);
    frame.extended = (frame_.can_id & CAN_EFF_FLAG) != 0 || frame.kind == CanFrameKind::kError;
    frame.id = frame_.can_id & (frame.extended ? CAN_EFF_MASK : CAN_SFF_MASK);
    frame.fd = fd_;
    frame.fd_flags = fd_ ? frame_.flags & kFdFlags : 0;
    const std::size_t largest = fd_ ? CANFD_MAX_DLEN : CAN_MAX_DLEN;
    frame.size_bytes = static_cast<std::uint8_t>(std::min<std::size_t>(frame_.len, largest));
    if (frame.kind != CanFrameKind::kRemote) {
        std::copy_n(std::begin(frame_.data), frame.size_bytes, frame.data.begin());
    }
    return frame;
}

SocketCanStamps SocketCanMessage::stamps() const {
    SocketCanStamps stamps{.wall_now = ReadClock(CLOCK_REALTIME), .now = Now()};
    scm_timestamping given{};
    const cmsghdr* const found = Find(SCM_TIMESTAMPING, sizeof given);
    if (found == nullptr) return stamps;
    std::memcpy(&given, CMSG_DATA(found), sizeof given);
    stamps.software = Given(given.ts[0]);
    stamps.hardware = Given(given.ts[2]);
    return stamps;
}

std::optional<std::uint32_t> SocketCanMessage::dropped() const {
    std::uint32_t dropped = 0;
    const cmsghdr* const found = Find(SO_RXQ_OVFL, sizeof dropped);
    if (found == nullptr) return std::nullopt;
    std::memcpy(&dropped, CMSG_DATA(found), sizeof dropped);
    return dropped;
}

const cmsghdr* SocketCanMessage::Find(int type, std::size_t bytes) const {
    msghdr header = header_;  // the macros want one that they could write to
    for (cmsghdr* one = CMSG_FIRSTHDR(&header); one != nullptr; one = CMSG_NXTHDR(&header, one)) {
        const bool wanted = one->cmsg_level == SOL_SOCKET && one->cmsg_type == type;
        const auto at = reinterpret_cast<const std::byte*>(one) - control_.data();
        const bool whole = header_.msg_controllen - static_cast<std::size_t>(at) >= CMSG_LEN(bytes);
        if (wanted && whole && one->cmsg_len >= CMSG_LEN(bytes)) return one;
    }
    return nullptr;
}

}  // namespace hitchview::drivers
