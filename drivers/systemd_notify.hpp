#pragma once

#include <memory>

#include "drivers/systemd_socket.hpp"
#include "hal/watchdog.hpp"

namespace hitchview::drivers {

/// Tells systemd that the service is ready and lives, as sd_notify(3) does. Takes no memory.
class SystemdNotify final : public hal::Watchdog {
 public:
    /// Null where nobody wants to be told: `address` is null or empty. It is what the environment
    /// variable NOTIFY_SOCKET says.
    static hal::Checked<std::unique_ptr<hal::Watchdog>> Open(const char* address);

 private:
    explicit SystemdNotify(SystemdSocket socket) : socket_(std::move(socket)) {}

    void DoReady() override;
    void DoFeed() override;
    void DoShow(const hal::Health& health) override;
    void DoStop() override;

    SystemdSocket socket_;
    bool ready_unsent_ = false;  // a manager that was too slow is told again
};

}  // namespace hitchview::drivers
