#pragma once

#include <arpa/inet.h>
#include <netinet/in.h>
#include <poll.h>
#include <sys/socket.h>
#include <unistd.h>

#include <algorithm>
#include <array>
#include <chrono>
#include <map>
#include <optional>
#include <string>

#include "hal/expect.hpp"

namespace hitchview::tests {

struct WebAnswer {
    int status = 0;
    std::map<std::string, std::string> headers{};  ///< names in lower case
    std::string body{};
};

/// One TCP connection to a server on this machine, as bare as they come.
class WebClient {
 public:
    explicit WebClient(int port, int receive_buffer_bytes = 0)
        : socket_(socket(AF_INET, SOCK_STREAM | SOCK_CLOEXEC, 0)) {
        HV_EXPECT(socket_ >= 0);
        if (receive_buffer_bytes > 0) {
            setsockopt(socket_, SOL_SOCKET, SO_RCVBUF, &receive_buffer_bytes,
                       sizeof(receive_buffer_bytes));
        }
        sockaddr_in address{};
        address.sin_family = AF_INET;
        address.sin_port = htons(static_cast<std::uint16_t>(port));
        address.sin_addr.s_addr = htonl(INADDR_LOOPBACK);
        connected_ =
            connect(socket_, reinterpret_cast<const sockaddr*>(&address), sizeof(address)) == 0;
    }
    ~WebClient() { close(socket_); }
    WebClient(const WebClient&) = delete;
    WebClient& operator=(const WebClient&) = delete;

    [[nodiscard]] bool connected() const { return connected_; }

    bool Send(const std::string& bytes) const {
        return send(socket_, bytes.data(), bytes.size(), MSG_NOSIGNAL) == std::ssize(bytes);
    }

    /// A request for a path, with further header lines each ended by "\r\n".
    bool Ask(const std::string& path, const std::string& headers = {},
             const std::string& method = "GET") const {
        const std::string host =
            headers.find("Host:") == std::string::npos ? "Host: 127.0.0.1\r\n" : "";
        return Send(method + " " + path + " HTTP/1.1\r\n" + host + headers + "\r\n");
    }

    /// The answer to the oldest request; nothing when the server closed or was silent for ten
    /// seconds. Bodies of a stated length only.
    std::optional<WebAnswer> Answer(bool has_body = true) {
        const auto head = TakeThrough("\r\n\r\n");
        if (!head) return std::nullopt;
        WebAnswer answer = Parsed(*head);
        if (!has_body || answer.headers["content-length"].empty()) return answer;
        const std::size_t size = std::stoul(answer.headers["content-length"]);
        while (received_.size() < size) {
            if (!Receive()) return std::nullopt;
        }
        answer.body = received_.substr(0, size);
        received_.erase(0, size);
        return answer;
    }

    std::optional<WebAnswer> Get(const std::string& path, const std::string& headers = {}) {
        return Ask(path, headers) ? Answer() : std::nullopt;
    }

    /// Everything up to a mark, the mark with it.
    std::optional<std::string> TakeThrough(const std::string& mark) {
        for (;;) {
            const std::size_t at = received_.find(mark);
            if (at != std::string::npos) {
                std::string taken = received_.substr(0, at + mark.size());
                received_.erase(0, taken.size());
                return taken;
            }
            if (!Receive()) return std::nullopt;
        }
    }

    /// False when the server has closed, or says nothing for so long.
    bool Receive(std::chrono::milliseconds patience = std::chrono::seconds(10)) {
        pollfd readable{socket_, POLLIN, 0};
        if (poll(&readable, 1, static_cast<int>(patience.count())) <= 0) return false;
        std::array<char, 65536> bytes{};
        const ssize_t count = recv(socket_, bytes.data(), bytes.size(), 0);
        if (count <= 0) return false;
        received_.append(bytes.data(), static_cast<std::size_t>(count));
        return true;
    }

 private:
    static WebAnswer Parsed(const std::string& head) {
        WebAnswer answer;
        answer.status = std::stoi(head.substr(head.find(' ') + 1));
        for (std::size_t at = head.find("\r\n") + 2; at < head.size() - 2;) {
            const std::size_t end = head.find("\r\n", at);
            const std::size_t colon = head.find(':', at);
            std::string name = head.substr(at, colon - at);
            std::ranges::transform(name, name.begin(), [](char c) {
                return c >= 'A' && c <= 'Z' ? static_cast<char>(c + 32) : c;
            });
            answer.headers[name] = head.substr(colon + 2, end - colon - 2);
            at = end + 2;
        }
        return answer;
    }

    int socket_;
    bool connected_ = false;
    std::string received_{};
};

}  // namespace hitchview::tests
