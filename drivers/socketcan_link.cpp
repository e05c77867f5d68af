#include "drivers/socketcan_link.hpp"

#include <linux/can/netlink.h>
#include <linux/if_link.h>
#include <linux/rtnetlink.h>
#include <net/if.h>
#include <net/if_arp.h>
#include <sys/socket.h>
#include <sys/time.h>

#include <algorithm>
#include <array>
#include <cerrno>
#include <cstring>

#include "drivers/socketcan_interfaces.hpp"

namespace hitchview::drivers {
namespace {

using Bytes = std::span<const std::byte>;

/// A value of the kernel's at the start of `bytes`, whatever their alignment; empty: cut off.
template <typename T>
std::optional<T> Read(Bytes bytes) {
    if (bytes.size() < sizeof(T)) return std::nullopt;
    T value{};
    std::memcpy(&value, bytes.data(), sizeof value);
    return value;
}

std::size_t Aligned(std::size_t bytes) {
    return (bytes + 3) & ~std::size_t{3};
}

/// The content of the first attribute of that type; empty: there is none.
std::optional<Bytes> Find(Bytes attributes, int type) {
    while (const auto header = Read<rtattr>(attributes)) {
        const std::size_t bytes = header->rta_len;
        if (bytes < sizeof *header || bytes > attributes.size()) return std::nullopt;
        // Flags share the field with the type.
        if ((header->rta_type & 0x3fff) == type)
            return attributes.subspan(sizeof *header, bytes - sizeof *header);
        attributes = attributes.subspan(std::min(Aligned(bytes), attributes.size()));
    }
    return std::nullopt;
}

std::string Text(Bytes bytes) {
    const auto* const first = reinterpret_cast<const char*>(bytes.data());
    return {first, strnlen(first, bytes.size())};
}

std::optional<CanLink::State> StateOf(std::uint32_t state) {
    using State = CanLink::State;
    switch (state) {
        case CAN_STATE_ERROR_ACTIVE:
            return State::kActive;
        case CAN_STATE_ERROR_WARNING:
            return State::kWarning;
        case CAN_STATE_ERROR_PASSIVE:
            return State::kPassive;
        case CAN_STATE_BUS_OFF:
            return State::kBusOff;
        case CAN_STATE_STOPPED:
            return State::kStopped;
        case CAN_STATE_SLEEPING:
            return State::kSleeping;
        default:
            return std::nullopt;
    }
}

void ReadController(Bytes data, CanLink& link) {
    if (const auto timing = Find(data, IFLA_CAN_BITTIMING))
        link.bit_rate = Read<std::uint32_t>(*timing).value_or(0);
    if (const auto restart = Find(data, IFLA_CAN_RESTART_MS))
        link.restart_ms = Read<std::uint32_t>(*restart).value_or(0);
    const auto state = Find(data, IFLA_CAN_STATE);
    const auto number = state ? Read<std::uint32_t>(*state) : std::nullopt;
    if (number) link.state = StateOf(*number);
}

struct LinkRequest {
    nlmsghdr header{};
    ifinfomsg link{};
};

/// The kernel's answer to a question about one interface; fewer bytes than a header: none.
Bytes Ask(int socket, int index, std::span<std::byte> memory) {
    LinkRequest request{};
    request.header.nlmsg_len = sizeof request;
    request.header.nlmsg_type = RTM_GETLINK;
    request.header.nlmsg_flags = NLM_F_REQUEST;
    request.link.ifi_family = AF_UNSPEC;
    request.link.ifi_index = index;
    if (send(socket, &request, sizeof request, 0) < 0) return {};
    const ssize_t bytes = recv(socket, memory.data(), memory.size(), 0);
    return bytes < 0 ? Bytes{} : Bytes(memory).first(static_cast<std::size_t>(bytes));
}

}  // namespace

std::optional<CanLink> ParseCanLink(Bytes message) {
    const auto header = Read<nlmsghdr>(message);
    if (!header || header->nlmsg_type != RTM_NEWLINK) return std::nullopt;
    message = message.first(std::min<std::size_t>(header->nlmsg_len, message.size()));
    if (message.size() < NLMSG_HDRLEN) return std::nullopt;
    const auto info = Read<ifinfomsg>(message.subspan(NLMSG_HDRLEN));
    if (!info) return std::nullopt;
    CanLink link{.is_can = info->ifi_type == ARPHRD_CAN, .is_up = (info->ifi_flags & IFF_UP) != 0};
    const std::size_t start = NLMSG_HDRLEN + Aligned(sizeof *info);
    if (start > message.size()) return link;
    const auto details = Find(message.subspan(start), IFLA_LINKINFO);
    if (!details) return link;
    if (const auto kind = Find(*details, IFLA_INFO_KIND)) link.kind = Text(*kind);
    const auto data = Find(*details, IFLA_INFO_DATA);
    if (link.is_can && link.kind == "can" && data) ReadController(*data, link);
    return link;
}

hal::Checked<CanLink> ReadCanLink(const std::string& name) {
    const unsigned index = if_nametoindex(name.c_str());
    if (index == 0) return "there is no interface '" + name + "'";
    const SocketCanHandle handle(socket(AF_NETLINK, SOCK_RAW | SOCK_CLOEXEC, NETLINK_ROUTE));
    constexpr timeval kPatience{.tv_sec = 0, .tv_usec = 500'000};
    if (!handle ||
        setsockopt(handle.get(), SOL_SOCKET, SO_RCVTIMEO, &kPatience, sizeof kPatience) != 0)
        return std::string("the kernel cannot be asked: ") + std::strerror(errno);
    std::array<std::byte, 32768> memory{};
    if (const auto link = ParseCanLink(Ask(handle.get(), static_cast<int>(index), memory)))
        return *link;
    return "the kernel does not answer about '" + name + "'";
}

}  // namespace hitchview::drivers
