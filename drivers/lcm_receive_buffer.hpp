#pragma once

#include <optional>

namespace hitchview::drivers {

/// Receive buffers that this system gives to sockets.
struct SocketBuffers {
    int usual_bytes = 0;    ///< of a socket that asks for nothing: net.core.rmem_default
    int largest_bytes = 0;  ///< that a socket may ask for: net.core.rmem_max
};

/// Asks the kernel with a socket, since the files of /proc/sys are not shown in every network
/// namespace. Empty where no socket can be had.
std::optional<SocketBuffers> ReadSocketBuffers();

/// What a subscriber asks for: room for four of the largest panoramas, or all that the system
/// grants. (liblcm complains of a system that grants less than it was asked for.)
int SubscriberBufferBytes();

}  // namespace hitchview::drivers
