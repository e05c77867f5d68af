#pragma once

#include <array>
#include <atomic>
#include <chrono>
#include <cstddef>
#include <cstdint>
#include <memory>
#include <string>
#include <vector>

#include "drivers/socketcan_interfaces.hpp"
#include "drivers/socketcan_message.hpp"
#include "drivers/socketcan_time.hpp"
#include "hal/can_bus.hpp"

namespace hitchview::drivers {

struct SocketCanId {
    std::uint32_t id = 0;  ///< at most 0x7ff, extended: at most 0x1fffffff
    bool extended = false;
};

struct SocketCanOptions {
    std::string interface {};  ///< can0
    /// The kernel hands over data frames of these only, at most kMaxIds; empty: of all.
    std::vector<SocketCanId> ids{};
    /// To record a bus: remote frames and error frames are delivered too, and `ids` is empty.
    bool record = false;
    int receive_buffer_bytes = 1 << 20;  ///< of the socket. [4096, 2^26]
};

/// One bus of the kernel (SocketCAN): classic and FD frames in the order of the bus, with the
/// kernel's time stamps (the controller's where it has a clock) as CLOCK_MONOTONIC moments.
///
/// It survives its interface. kDisconnected comes while it is down or bus-off: at once when that
/// happens, then after each `timeout`. An interface that is deleted is opened again when one of its
/// name is back, tried after 100 ms, doubling to 500 ms. Error frames are counted; one that says
/// bus-off disconnects until a frame comes or the controller says that it was restarted.
/// What the kernel had no room for is counted when the socket has been read empty, exactly.
///
/// Takes no memory after Open, also when the interface is opened again.
class SocketCanBus final : public hal::CanBus {
 public:
    static constexpr std::size_t kMaxIds = 512;  ///< the kernel's own limit

    /// The error is for a person: no such interface (and which there are), not a CAN interface, no
    /// CAN in the kernel, no permission. An interface that is down may be opened.
    static hal::Checked<std::unique_ptr<SocketCanBus>> Open(const SocketCanOptions& options);

    /// What Open has to say though it succeeded, for the log: a smaller receive buffer. Mostly
    /// empty.
    [[nodiscard]] const std::string& remark() const { return remark_; }

 private:
    using Instant = hal::Instant;

    explicit SocketCanBus(const SocketCanOptions& options);

    hal::Result<hal::CanFrame> DoWaitFrame(std::chrono::milliseconds timeout) override;
    [[nodiscard]] hal::CanCounts DoCounts() const override;

    /// 0, or errno of the call that failed, which is then `failed_call_`. The socket is closed
    /// then.
    int OpenSocket();
    int Configure(int socket);
    void TakeReceiveBuffer(int socket);
    void Reopen(Instant until);
    /// kTimeout: nothing there, or nothing for the caller.
    hal::Result<hal::CanFrame> Read();
    hal::Result<hal::CanFrame> Deliver();
    hal::Result<hal::CanFrame> Fail(int error);
    bool CountError();
    void CountDropped(std::uint32_t dropped);
    void CountDroppedExactly();
    void Disconnect();
    [[nodiscard]] hal::Error Silence();

    const SocketCanOptions options_;
    std::array<char, 16> name_{};  // IFNAMSIZ
    std::string remark_;
    const char* failed_call_ = "";
    SocketCanHandle socket_;
    SocketCanMessage message_;
    SocketCanTime time_;

    bool connected_ = true;
    bool bus_off_ = false;
    Instant retry_after_;
    Instant next_try_{};
    std::uint32_t dropped_by_socket_ = 0;  // of the open socket, modulo 2^32

    std::atomic<std::uint64_t> delivered_{0};
    std::atomic<std::uint64_t> dropped_{0};
    std::atomic<std::uint64_t> errors_{0};
    std::atomic<std::uint64_t> disconnections_{0};
};

}  // namespace hitchview::drivers
