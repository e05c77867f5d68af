#pragma once

#include <poll.h>
#include <sys/socket.h>
#include <sys/un.h>
#include <unistd.h>

#include <array>
#include <chrono>
#include <cstddef>
#include <optional>
#include <string>
#include <vector>

#include "hal/expect.hpp"

namespace hitchview::tests {

/// Stands where a service of systemd listens: a local datagram socket.
class DatagramListener {
 public:
    /// `address`: a path, or an abstract name behind '@'.
    explicit DatagramListener(std::string address)
        : file_(socket(AF_UNIX, SOCK_DGRAM | SOCK_CLOEXEC, 0)) {
        sockaddr_un name{};
        name.sun_family = AF_UNIX;
        HV_EXPECT(file_ >= 0 && address.size() < sizeof name.sun_path);
        if (address.front() == '@') address.front() = '\0';
        address.copy(name.sun_path, address.size());
        const auto bytes = static_cast<socklen_t>(offsetof(sockaddr_un, sun_path) + address.size());
        HV_EXPECT(bind(file_, reinterpret_cast<const sockaddr*>(&name), bytes) == 0);
    }
    ~DatagramListener() { close(file_); }
    DatagramListener(const DatagramListener&) = delete;
    DatagramListener& operator=(const DatagramListener&) = delete;

    /// The next datagram; empty if none comes within `timeout`.
    std::optional<std::string> Take(std::chrono::milliseconds timeout) {
        pollfd waited{file_, POLLIN, 0};
        if (poll(&waited, 1, static_cast<int>(timeout.count())) <= 0) return std::nullopt;
        std::array<char, 8192> bytes{};
        const ssize_t count = recv(file_, bytes.data(), bytes.size(), 0);
        HV_EXPECT(count >= 0);
        return std::string(bytes.data(), static_cast<std::size_t>(count));
    }

    /// Those that wait.
    std::vector<std::string> TakeAll() {
        std::vector<std::string> all;
        while (auto next = Take(std::chrono::milliseconds(0))) all.push_back(std::move(*next));
        return all;
    }

 private:
    int file_;
};

}  // namespace hitchview::tests
