#include "app/web_listen.hpp"

#include <arpa/inet.h>
#include <netinet/in.h>
#include <sys/socket.h>
#include <unistd.h>

#include <cerrno>
#include <cstring>
#include <optional>
#include <system_error>

namespace hitchview::app {
namespace {

using hal::Checked;

constexpr int kBacklog = 64;
/// The kernel takes twice as much. Connections inherit it from the socket that listens.
constexpr int kSendBufferBytes = 128 << 10;

struct Address {
    sockaddr_storage storage{};
    socklen_t bytes = 0;
};

std::optional<Address> AddressOf(const std::string& text, int port) {
    Address address;
    const auto network_port = htons(static_cast<std::uint16_t>(port));
    auto* const ip4 = reinterpret_cast<sockaddr_in*>(&address.storage);
    auto* const ip6 = reinterpret_cast<sockaddr_in6*>(&address.storage);
    if (inet_pton(AF_INET, text.c_str(), &ip4->sin_addr) == 1) {
        ip4->sin_family = AF_INET;
        ip4->sin_port = network_port;
        address.bytes = sizeof(sockaddr_in);
    } else if (inet_pton(AF_INET6, text.c_str(), &ip6->sin6_addr) == 1) {
        ip6->sin6_family = AF_INET6;
        ip6->sin6_port = network_port;
        address.bytes = sizeof(sockaddr_in6);
    } else {
        return std::nullopt;
    }
    return address;
}

int PortOf(int descriptor) {
    Address address;
    address.bytes = sizeof(address.storage);
    getsockname(descriptor, reinterpret_cast<sockaddr*>(&address.storage), &address.bytes);
    return ntohs(address.storage.ss_family == AF_INET
                     ? reinterpret_cast<const sockaddr_in*>(&address.storage)->sin_port
                     : reinterpret_cast<const sockaddr_in6*>(&address.storage)->sin6_port);
}

void SetOption(int descriptor, int option, int value) {
    setsockopt(descriptor, SOL_SOCKET, option, &value, sizeof(value));
}

}  // namespace

Checked<ListeningSocket> Listen(const std::string& address, int port) {
    const auto maybe_address = AddressOf(address, port);
    if (!maybe_address) return "'" + address + "' is no IPv4 or IPv6 address";
    const int descriptor =
        socket(maybe_address->storage.ss_family, SOCK_STREAM | SOCK_CLOEXEC | SOCK_NONBLOCK, 0);
    if (descriptor < 0) return "no socket: " + std::system_category().message(errno);
    SetOption(descriptor, SO_REUSEADDR, 1);
    SetOption(descriptor, SO_SNDBUF, kSendBufferBytes);
    const auto* const where = reinterpret_cast<const sockaddr*>(&maybe_address->storage);
    if (bind(descriptor, where, maybe_address->bytes) != 0 || listen(descriptor, kBacklog) != 0) {
        const int reason = errno;
        close(descriptor);
        return "cannot listen at " + address + " port " + std::to_string(port) + ": " +
               std::system_category().message(reason) +
               (reason == EADDRINUSE ? "; another --port, or --port 0, may be free" : "");
    }
    return ListeningSocket{descriptor, PortOf(descriptor)};
}

bool IsLoopback(const std::string& address) {
    return address.starts_with("127.") || address == "::1";
}

}  // namespace hitchview::app
