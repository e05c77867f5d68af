#pragma once

#include <linux/can.h>

#include <string>
#include <vector>

namespace hitchview::tests {

/// Whether this kernel has virtual CAN interfaces and this user may make them; in the virtual
/// machine of toolchain/vm it is so.
bool HasVirtualCan();

/// Runs a shell command; its exit code.
int Shell(const std::string& command);

/// A virtual CAN interface (FD, up) that goes with the object.
class VirtualCan {
 public:
    explicit VirtualCan(std::string name);
    ~VirtualCan();
    VirtualCan(const VirtualCan&) = delete;
    VirtualCan& operator=(const VirtualCan&) = delete;

    void Add();
    void Delete();
    void Up();
    void Down();
    [[nodiscard]] const std::string& name() const { return name_; }

 private:
    std::string name_;
};

/// Sends on an interface that exists, and receives nothing.
class CanSender {
 public:
    explicit CanSender(const std::string& interface);
    ~CanSender();
    CanSender(const CanSender&) = delete;
    CanSender& operator=(const CanSender&) = delete;

    /// Waits while the interface has no room. False: the interface refuses.
    bool Send(const can_frame& frame);
    bool Send(const canfd_frame& frame);
    /// All of them with few system calls, in order.
    bool Send(const std::vector<can_frame>& frames);

 private:
    int socket_;
};

}  // namespace hitchview::tests
