#pragma once

#include <string>
#include <vector>

#include "hal/result.hpp"

/// What the kernel says about its network interfaces. Used by the SocketCAN driver alone.
namespace hitchview::drivers {

/// Closes the file descriptor that it owns.
class SocketCanHandle {
 public:
    SocketCanHandle() = default;
    explicit SocketCanHandle(int descriptor) : descriptor_(descriptor) {}
    SocketCanHandle(const SocketCanHandle&) = delete;
    SocketCanHandle& operator=(const SocketCanHandle&) = delete;
    SocketCanHandle(SocketCanHandle&& other) noexcept;
    SocketCanHandle& operator=(SocketCanHandle&& other) noexcept;
    ~SocketCanHandle() { Close(); }

    void Close();
    [[nodiscard]] int get() const { return descriptor_; }
    explicit operator bool() const { return descriptor_ >= 0; }

 private:
    int descriptor_ = -1;
};

/// Names of all CAN interfaces, up or down, as the kernel orders them.
std::vector<std::string> CanInterfaces();

/// Whether `name` is a CAN interface. The error names those that there are.
hal::Checked<hal::Done> CheckCanInterface(const std::string& name);

/// Index of the interface; 0 when there is none of that name. `socket`: any. Takes no memory.
int InterfaceIndex(int socket, const char* name);

/// Up and, as far as the driver knows, on the bus: a controller that is bus-off is not.
/// Takes no memory.
bool IsInterfaceRunning(int socket, const char* name);

}  // namespace hitchview::drivers
