#include "tests/support/virtual_can.hpp"

#include <linux/can/raw.h>
#include <net/if.h>
#include <sys/socket.h>
#include <unistd.h>

#include <cerrno>
#include <cstdlib>

#include "hal/expect.hpp"

namespace hitchview::tests {
namespace {

// Whether to write again: a virtual bus without room for a moment.
bool IsFull() {
    return errno == ENOBUFS || errno == EAGAIN || errno == EINTR;
}

template <typename Frame>
bool Write(int socket, const Frame& frame) {
    while (write(socket, &frame, sizeof frame) != sizeof frame) {
        if (!IsFull()) return false;
    }
    return true;
}

}  // namespace

bool HasVirtualCan() {
    // Elsewhere the interfaces of the machine are left alone.
    return std::getenv("VM_OUT") != nullptr && Shell("modprobe -a vcan can-raw 2>/dev/null") == 0;
}

int Shell(const std::string& command) {
    return std::system(command.c_str());
}

VirtualCan::VirtualCan(std::string name) : name_(std::move(name)) {
    Add();
}

VirtualCan::~VirtualCan() {
    Shell("ip link delete " + name_ + " 2>/dev/null");
}

void VirtualCan::Add() {
    HV_EXPECT(Shell("ip link add " + name_ + " type vcan") == 0);
    HV_EXPECT(Shell("ip link set " + name_ + " mtu 72 up") == 0);
}

void VirtualCan::Delete() {
    HV_EXPECT(Shell("ip link delete " + name_) == 0);
}

void VirtualCan::Up() {
    HV_EXPECT(Shell("ip link set " + name_ + " up") == 0);
}

void VirtualCan::Down() {
    HV_EXPECT(Shell("ip link set " + name_ + " down") == 0);
}

CanSender::CanSender(const std::string& interface)
    : socket_(socket(PF_CAN, SOCK_RAW | SOCK_CLOEXEC, CAN_RAW)) {
    HV_EXPECT(socket_ >= 0);
    constexpr int kOn = 1;
    setsockopt(socket_, SOL_CAN_RAW, CAN_RAW_FILTER, nullptr, 0);
    setsockopt(socket_, SOL_CAN_RAW, CAN_RAW_FD_FRAMES, &kOn, sizeof kOn);
    sockaddr_can address{};
    address.can_family = AF_CAN;
    address.can_ifindex = static_cast<int>(if_nametoindex(interface.c_str()));
    HV_EXPECT(bind(socket_, reinterpret_cast<const sockaddr*>(&address), sizeof address) == 0);
}

CanSender::~CanSender() {
    close(socket_);
}

bool CanSender::Send(const can_frame& frame) {
    return Write(socket_, frame);
}

bool CanSender::Send(const canfd_frame& frame) {
    return Write(socket_, frame);
}

bool CanSender::Send(const std::vector<can_frame>& frames) {
    std::vector<iovec> places;
    for (const can_frame& frame : frames)
        places.push_back({const_cast<can_frame*>(&frame), sizeof frame});
    std::vector<mmsghdr> messages(frames.size());
    for (std::size_t i = 0; i < frames.size(); ++i) {
        messages[i].msg_hdr.msg_iov = &places[i];
        messages[i].msg_hdr.msg_iovlen = 1;
    }
    for (std::size_t sent = 0; sent < frames.size();) {
        const auto left = static_cast<unsigned>(frames.size() - sent);
        const int more = sendmmsg(socket_, &messages[sent], left, 0);
        if (more < 0 && !IsFull()) return false;
        if (more > 0) sent += static_cast<std::size_t>(more);
    }
    return true;
}

}  // namespace hitchview::tests
