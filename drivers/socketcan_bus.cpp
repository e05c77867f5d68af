#include "drivers/socketcan_bus.hpp"

#include <linux/can/error.h>
#include <linux/can/raw.h>
#include <linux/net_tstamp.h>
#include <linux/sock_diag.h>
#include <poll.h>

#include <algorithm>
#include <cerrno>
#include <cstring>
#include <ctime>

#include "drivers/frame_clock.hpp"
#include "hal/expect.hpp"

namespace hitchview::drivers {
namespace {

using hal::CanFrame;
using hal::Error;
using hal::Instant;

constexpr Instant kFirstRetry = std::chrono::milliseconds(100);
constexpr Instant kLongestRetry = std::chrono::milliseconds(500);

template <typename Value>
bool Set(int socket, int level, int option, const Value& value) {
    return setsockopt(socket, level, option, &value, sizeof value) == 0;
}

void SleepUntil(Instant when) {
    const auto whole = std::chrono::duration_cast<std::chrono::seconds>(when);
    const timespec time{.tv_sec = whole.count(), .tv_nsec = (when - whole).count()};
    clock_nanosleep(CLOCK_MONOTONIC, TIMER_ABSTIME, &time, nullptr);
}

// Until the socket has something to read or to complain about, or `until` is past.
void WaitReadable(int socket, Instant until) {
    using std::chrono::ceil;
    pollfd wait{.fd = socket, .events = POLLIN, .revents = 0};
    const auto left = ceil<std::chrono::milliseconds>(std::max(until - Now(), Instant(0)));
    poll(&wait, 1, static_cast<int>(std::min<std::int64_t>(left.count(), 1000)));
}

// The identifier with its format, and that the frame is no remote frame.
can_filter FilterFor(const SocketCanId& id) {
    const canid_t format = id.extended ? CAN_EFF_FLAG : 0;
    const canid_t bits = id.extended ? CAN_EFF_MASK : CAN_SFF_MASK;
    return {.can_id = id.id | format, .can_mask = bits | CAN_EFF_FLAG | CAN_RTR_FLAG};
}

bool SetFilters(int socket, const SocketCanOptions& options) {
    std::array<can_filter, SocketCanBus::kMaxIds> filters{};
    std::size_t count = options.ids.size();
    std::transform(options.ids.begin(), options.ids.end(), filters.begin(), FilterFor);
    if (options.ids.empty()) {
        filters[0] = {.can_id = 0, .can_mask = options.record ? 0 : CAN_RTR_FLAG};
        count = 1;
    }
    const auto bytes = static_cast<socklen_t>(count * sizeof filters[0]);
    return setsockopt(socket, SOL_CAN_RAW, CAN_RAW_FILTER, filters.data(), bytes) == 0;
}

bool SetStamps(int socket) {
    const int wanted = SOF_TIMESTAMPING_RX_SOFTWARE | SOF_TIMESTAMPING_SOFTWARE |
                       SOF_TIMESTAMPING_RX_HARDWARE | SOF_TIMESTAMPING_RAW_HARDWARE;
    return Set(socket, SOL_SOCKET, SO_TIMESTAMPING, wanted);
}

std::string Explained(const std::string& interface, const char* call, int error) {
    const std::string what =
        "CAN interface " + interface + ": " + call + ": " + std::strerror(error);
    if (error == EAFNOSUPPORT || error == EPROTONOSUPPORT) {
        return what +
               " (this kernel has no CAN, or the service may not use it: `modprobe can_raw`; "
               "in a unit AF_CAN must be among RestrictAddressFamilies)";
    }
    if (error == EPERM || error == EACCES) {
        return what + " (this user may not use it: CAP_NET_RAW, or the service's own restrictions)";
    }
    return what;
}

hal::Checked<hal::Done> CheckIds(const SocketCanOptions& options) {
    HV_EXPECT(!options.record || options.ids.empty());
    if (options.ids.size() <= SocketCanBus::kMaxIds) return hal::Done{};
    return "CAN interface " + options.interface + ": " + std::to_string(options.ids.size()) +
           " identifiers, must be at most " + std::to_string(SocketCanBus::kMaxIds);
}

}  // namespace

SocketCanBus::SocketCanBus(const SocketCanOptions& options)
    : options_(options), time_(ReadClock(CLOCK_REALTIME), Now()), retry_after_(kFirstRetry) {
    options_.interface.copy(name_.data(), name_.size() - 1);
}

hal::Checked<std::unique_ptr<SocketCanBus>> SocketCanBus::Open(const SocketCanOptions& options) {
    if (const auto ids = CheckIds(options); !ids) return ids.error();
    if (auto interface = CheckCanInterface(options.interface); !interface) return interface.error();
    std::unique_ptr<SocketCanBus> self(new SocketCanBus(options));
    if (const int error = self->OpenSocket(); error != 0) {
        return Explained(options.interface, self->failed_call_, error);
    }
    self->TakeReceiveBuffer(self->socket_.get());
    return self;
}

int SocketCanBus::OpenSocket() {
    SocketCanHandle opened(socket(PF_CAN, SOCK_RAW | SOCK_CLOEXEC, CAN_RAW));
    failed_call_ = "socket";
    if (!opened) return errno;
    if (const int error = Configure(opened.get()); error != 0) return error;
    sockaddr_can address{};
    address.can_family = AF_CAN;
    address.can_ifindex = InterfaceIndex(opened.get(), name_.data());
    failed_call_ = "bind";
    if (address.can_ifindex == 0) return ENODEV;
    if (bind(opened.get(), reinterpret_cast<const sockaddr*>(&address), sizeof address) != 0)
        return errno;
    dropped_by_socket_ = 0;
    socket_ = std::move(opened);
    return 0;
}

// All of it before the socket is bound: no frame comes that was not asked for.
int SocketCanBus::Configure(int socket) {
    constexpr int kOn = 1;
    constexpr can_err_mask_t kAllErrors = CAN_ERR_MASK;
    failed_call_ = "CAN_RAW_FILTER";
    if (!SetFilters(socket, options_)) return errno;
    failed_call_ = "CAN_RAW_ERR_FILTER";
    if (!Set(socket, SOL_CAN_RAW, CAN_RAW_ERR_FILTER, kAllErrors)) return errno;
    failed_call_ = "CAN_RAW_FD_FRAMES";
    if (!Set(socket, SOL_CAN_RAW, CAN_RAW_FD_FRAMES, kOn)) return errno;
    failed_call_ = "SO_TIMESTAMPING";
    if (!SetStamps(socket)) return errno;
    failed_call_ = "SO_RXQ_OVFL";
    if (!Set(socket, SOL_SOCKET, SO_RXQ_OVFL, kOn)) return errno;
    // A root process may pass the limit net.core.rmem_max.
    if (!Set(socket, SOL_SOCKET, SO_RCVBUFFORCE, options_.receive_buffer_bytes))
        Set(socket, SOL_SOCKET, SO_RCVBUF, options_.receive_buffer_bytes);
    return 0;
}

void SocketCanBus::TakeReceiveBuffer(int socket) {
    int bytes = 0;
    socklen_t size = sizeof bytes;
    getsockopt(socket, SOL_SOCKET, SO_RCVBUF, &bytes, &size);
    bytes /= 2;  // the kernel doubles what it is asked for, for its own records
    if (bytes >= options_.receive_buffer_bytes) return;
    remark_ = "CAN interface " + options_.interface + ": the kernel gives a receive buffer of " +
              std::to_string(bytes) + " bytes instead of " +
              std::to_string(options_.receive_buffer_bytes) +
              "; `sysctl -w net.core.rmem_max=" + std::to_string(options_.receive_buffer_bytes) +
              "` lets it give more";
}

hal::CanCounts SocketCanBus::DoCounts() const {
    return {.delivered = delivered_,
            .dropped = dropped_,
            .errors = errors_,
            .disconnections = disconnections_};
}

hal::Result<CanFrame> SocketCanBus::DoWaitFrame(std::chrono::milliseconds timeout) {
    const Instant until = Now() + timeout;
    while (true) {
        const auto frame = Read();
        if (frame || frame.error() != Error::kTimeout) return frame;
        if (Now() >= until) return Silence();
        socket_ ? WaitReadable(socket_.get(), until) : Reopen(until);
    }
}

hal::Result<CanFrame> SocketCanBus::Read() {
    if (!socket_) return Error::kTimeout;
    const int error = message_.Receive(socket_.get());
    if (error == EAGAIN || error == EINTR) {
        CountDroppedExactly();
        return Error::kTimeout;
    }
    if (error != 0) return Fail(error);
    if (const auto dropped = message_.dropped()) CountDropped(*dropped);
    const bool is_lost = message_.IsError() && CountError();
    if (!message_.IsError() || options_.record) return Deliver();
    return is_lost ? Error::kDisconnected : Error::kTimeout;
}

hal::Result<CanFrame> SocketCanBus::Deliver() {
    CanFrame frame = message_.frame();
    const SocketCanStamps stamps = message_.stamps();
    frame.received_at = time_.ReceivedAt(stamps);
    frame.epoch = stamps.software.value_or(stamps.wall_now);
    const bool is_from_bus = frame.kind != hal::CanFrameKind::kError;
    if (is_from_bus) bus_off_ = false;
    // What had been received before the interface went down says nothing about it now.
    if (is_from_bus && !connected_) connected_ = IsInterfaceRunning(socket_.get(), name_.data());
    ++delivered_;
    return frame;
}

hal::Result<CanFrame> SocketCanBus::Fail(int error) {
    if (error == EBADMSG) return Error::kCorrupted;
    Disconnect();
    if (error == ENETDOWN) return Error::kDisconnected;
    // The interface is gone, and with it what the socket was bound to.
    CountDroppedExactly();
    socket_.Close();
    retry_after_ = kFirstRetry;
    next_try_ = Now() + retry_after_;
    return Error::kDisconnected;
}

void SocketCanBus::Reopen(Instant until) {
    SleepUntil(std::min(next_try_, until));
    if (Now() < next_try_ || OpenSocket() == 0) return;
    retry_after_ = std::min(2 * retry_after_, kLongestRetry);
    next_try_ = Now() + retry_after_;
}

// Whether it takes the bus away.
bool SocketCanBus::CountError() {
    ++errors_;
    if ((message_.error_classes() & CAN_ERR_RESTARTED) != 0) bus_off_ = false;
    if ((message_.error_classes() & CAN_ERR_BUSOFF) == 0) return false;
    bus_off_ = true;
    Disconnect();
    return true;
}

void SocketCanBus::CountDropped(std::uint32_t dropped) {
    // Modulo 2^32, as the kernel counts. A frame that came before the exact count was asked for
    // may be read after it.
    const auto more = static_cast<std::int32_t>(dropped - dropped_by_socket_);
    if (more <= 0) return;
    dropped_ += static_cast<std::uint64_t>(more);
    dropped_by_socket_ = dropped;
}

// A frame tells what was dropped before it; the last ones have none after them.
void SocketCanBus::CountDroppedExactly() {
    std::array<std::uint32_t, SK_MEMINFO_VARS> memory{};
    socklen_t bytes = sizeof memory;
    if (getsockopt(socket_.get(), SOL_SOCKET, SO_MEMINFO, memory.data(), &bytes) != 0) return;
    if (bytes > SK_MEMINFO_DROPS * sizeof memory[0]) CountDropped(memory[SK_MEMINFO_DROPS]);
}

void SocketCanBus::Disconnect() {
    if (connected_) ++disconnections_;
    connected_ = false;
}

hal::Error SocketCanBus::Silence() {
    const bool is_there = socket_ && !bus_off_ && IsInterfaceRunning(socket_.get(), name_.data());
    if (is_there) {
        connected_ = true;
        return Error::kTimeout;
    }
    Disconnect();
    return Error::kDisconnected;
}

}  // namespace hitchview::drivers
