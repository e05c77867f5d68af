#include "drivers/systemd_socket.hpp"

#include <unistd.h>

#include <algorithm>
#include <cerrno>
#include <cstddef>
#include <cstring>
#include <utility>

namespace hitchview::drivers {
namespace {

constexpr std::size_t kMostLetters = sizeof(sockaddr_un::sun_path) - 1;

bool IsAbstract(std::string_view address) {
    return address.starts_with('@');
}

/// A path has a NUL at its end.
socklen_t AddressBytes(std::string_view address) {
    const std::size_t letters = address.size() + (IsAbstract(address) ? 0 : 1);
    return static_cast<socklen_t>(offsetof(sockaddr_un, sun_path) + letters);
}

}  // namespace

hal::Checked<SystemdSocket> SystemdSocket::Open(std::string_view address) {
    const bool named = address.starts_with('/') || IsAbstract(address);
    if (!named || address.size() < 2 || address.size() > kMostLetters) {
        return std::string(address) +
               ", must be a path that starts with / or a name that starts with @, of 2 to " +
               std::to_string(kMostLetters) + " letters";
    }
    const int file = socket(AF_UNIX, SOCK_DGRAM | SOCK_CLOEXEC, 0);
    if (file < 0) return std::string(address) + ": no socket: " + std::strerror(errno);
    return SystemdSocket(file, address);
}

SystemdSocket::SystemdSocket(int file, std::string_view address)
    : file_(file), address_bytes_(AddressBytes(address)) {
    address_.sun_family = AF_UNIX;
    std::ranges::copy(address, address_.sun_path);
    if (IsAbstract(address)) address_.sun_path[0] = '\0';
}

SystemdSocket::SystemdSocket(SystemdSocket&& other) noexcept
    : file_(std::exchange(other.file_, -1)),
      address_(other.address_),
      address_bytes_(other.address_bytes_) {}

SystemdSocket::~SystemdSocket() {
    if (file_ >= 0) close(file_);
}

bool SystemdSocket::Send(std::string_view datagram) const {
    // With the address each time: the manager may be another process than at the start.
    return sendto(file_, datagram.data(), datagram.size(), MSG_DONTWAIT | MSG_NOSIGNAL,
                  reinterpret_cast<const sockaddr*>(&address_), address_bytes_) >= 0;
}

}  // namespace hitchview::drivers
