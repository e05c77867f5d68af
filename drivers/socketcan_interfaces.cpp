#include "drivers/socketcan_interfaces.hpp"

#include <net/if.h>
#include <net/if_arp.h>
#include <sys/ioctl.h>
#include <sys/socket.h>
#include <unistd.h>

#include <algorithm>
#include <cstring>
#include <utility>

namespace hitchview::drivers {
namespace {

ifreq RequestFor(const char* name) {
    ifreq request{};
    std::strncpy(request.ifr_name, name, IFNAMSIZ - 1);
    return request;
}

bool IsCan(int socket, const char* name) {
    ifreq request = RequestFor(name);
    return ioctl(socket, SIOCGIFHWADDR, &request) == 0 &&
           request.ifr_hwaddr.sa_family == ARPHRD_CAN;
}

// Interfaces are asked about through any socket.
SocketCanHandle AnySocket() {
    return SocketCanHandle(socket(AF_UNIX, SOCK_DGRAM | SOCK_CLOEXEC, 0));
}

std::string ThoseThereAre() {
    const auto names = CanInterfaces();
    if (names.empty()) {
        return "this machine has none: is the adapter plugged in and its module loaded? "
               "(`ip link add vcan0 type vcan` makes a virtual one)";
    }
    std::string text = "those of this machine:";
    for (const std::string& name : names) text += " " + name;
    return text;
}

}  // namespace

SocketCanHandle::SocketCanHandle(SocketCanHandle&& other) noexcept
    : descriptor_(std::exchange(other.descriptor_, -1)) {}

SocketCanHandle& SocketCanHandle::operator=(SocketCanHandle&& other) noexcept {
    std::swap(descriptor_, other.descriptor_);
    return *this;
}

void SocketCanHandle::Close() {
    if (descriptor_ >= 0) close(descriptor_);
    descriptor_ = -1;
}

std::vector<std::string> CanInterfaces() {
    std::vector<std::string> names;
    const SocketCanHandle socket = AnySocket();
    struct if_nameindex* const all = if_nameindex();
    if (all == nullptr) return names;
    for (const auto* one = all; one->if_name != nullptr; ++one) {
        if (IsCan(socket.get(), one->if_name)) names.emplace_back(one->if_name);
    }
    if_freenameindex(all);
    return names;
}

hal::Checked<hal::Done> CheckCanInterface(const std::string& name) {
    const SocketCanHandle socket = AnySocket();
    const bool exists =
        name.size() < IFNAMSIZ && !name.empty() && InterfaceIndex(socket.get(), name.c_str()) > 0;
    if (!exists)
        return "there is no interface '" + name + "', must be a CAN interface; " + ThoseThereAre();
    if (IsCan(socket.get(), name.c_str())) return hal::Done{};
    return "'" + name + "' is not a CAN interface, must be one; " + ThoseThereAre();
}

int InterfaceIndex(int socket, const char* name) {
    ifreq request = RequestFor(name);
    return ioctl(socket, SIOCGIFINDEX, &request) == 0 ? request.ifr_ifindex : 0;
}

bool IsInterfaceRunning(int socket, const char* name) {
    constexpr int kNeeded = IFF_UP | IFF_RUNNING;
    ifreq request = RequestFor(name);
    return ioctl(socket, SIOCGIFFLAGS, &request) == 0 && (request.ifr_flags & kNeeded) == kNeeded;
}

}  // namespace hitchview::drivers
