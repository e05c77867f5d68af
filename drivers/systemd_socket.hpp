#pragma once

#include <sys/socket.h>
#include <sys/un.h>

#include <string>
#include <string_view>

#include "hal/result.hpp"

namespace hitchview::drivers {

/// Datagrams to a service of systemd on this machine. Sending neither waits nor takes memory.
class SystemdSocket {
 public:
    /// `address`: a path from the root, or a name of the abstract namespace behind '@'; at most 107
    /// letters. Nobody needs to listen there yet. The error says what is wrong with it.
    static hal::Checked<SystemdSocket> Open(std::string_view address);
    ~SystemdSocket();
    SystemdSocket(SystemdSocket&& other) noexcept;
    SystemdSocket& operator=(SystemdSocket&&) = delete;

    /// False: nobody listens, or is too slow.
    bool Send(std::string_view datagram) const;

 private:
    SystemdSocket(int file, std::string_view address);

    int file_;
    sockaddr_un address_{};
    socklen_t address_bytes_ = 0;
};

}  // namespace hitchview::drivers
