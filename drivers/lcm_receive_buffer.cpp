#include "drivers/lcm_receive_buffer.hpp"

#include <sys/socket.h>
#include <unistd.h>

#include <algorithm>

namespace hitchview::drivers {
namespace {

/// More than any system grants; doubled, it is still an int.
constexpr int kMoreThanGranted = 1 << 30;

int ReceiveBuffer(int socket) {
    int bytes = 0;
    socklen_t size = sizeof bytes;
    return getsockopt(socket, SOL_SOCKET, SO_RCVBUF, &bytes, &size) == 0 ? bytes : 0;
}

}  // namespace

std::optional<SocketBuffers> ReadSocketBuffers() {
    const int probe = socket(AF_INET, SOCK_DGRAM | SOCK_CLOEXEC, 0);
    if (probe < 0) return std::nullopt;
    SocketBuffers buffers{.usual_bytes = ReceiveBuffer(probe)};
    setsockopt(probe, SOL_SOCKET, SO_RCVBUF, &kMoreThanGranted, sizeof kMoreThanGranted);
    // The kernel grants the smaller of what was asked for and rmem_max, and doubles it.
    buffers.largest_bytes = ReceiveBuffer(probe) / 2;
    close(probe);
    return buffers;
}

int SubscriberBufferBytes() {
    constexpr int kWanted = 16 << 20;
    const auto buffers = ReadSocketBuffers();
    return buffers ? std::min(kWanted, 2 * buffers->largest_bytes) : kWanted;
}

}  // namespace hitchview::drivers
