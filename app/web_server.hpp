#pragma once

#include <microhttpd.h>

#include <chrono>
#include <cstdint>
#include <deque>
#include <memory>
#include <string>
#include <string_view>

#include "app/web_budget.hpp"
#include "app/web_recordings.hpp"
#include "app/web_request.hpp"
#include "app/web_state.hpp"
#include "app/web_stream.hpp"
#include "hal/result.hpp"

namespace hitchview::app {

struct WebServerOptions {
    std::string address = "127.0.0.1";  ///< IPv4 or IPv6
    int port = 0;                       ///< [0, 65535]; 0: one that is free
    int connections = 256;              ///< at most; further ones wait until one ends. [4, 1024]
    double bytes_per_s = 40e6;          ///< pictures to all clients together
};

/// Serves the page. It has no thread: Serve does what can be done without waiting. Each connection
/// has a bounded memory, and a client that takes nothing for a while is closed. Thread: one, that
/// of the state.
class WebServer {
 public:
    /// `state` and `recordings` must outlive the server. The error says why there is none: the port
    /// is taken, the address is not ours.
    static hal::Checked<std::unique_ptr<WebServer>> Create(const WebServerOptions& options,
                                                           const WebState& state,
                                                           const WebRecordings& recordings);
    ~WebServer();
    WebServer(const WebServer&) = delete;
    WebServer& operator=(const WebServer&) = delete;

    [[nodiscard]] int port() const { return port_; }

    /// Readable when clients want something.
    [[nodiscard]] int descriptor() const;
    /// How long it may be left alone while the descriptor is not readable, at most `longest`.
    [[nodiscard]] std::chrono::milliseconds Patience(std::chrono::milliseconds longest) const;

    /// Call when the descriptor is readable, when patience is over, and when the state changed.
    void Serve(hal::Instant now);

    /// The state is due to all clients.
    void Announce(hal::Instant now) { streams_.Announce(now); }

 private:
    enum class Turn { kWaits, kNews, kNothing };

    /// One that is not answered yet; what stands below `waits` is of those that wait for something
    /// newer than the client has.
    struct Request {
        MHD_Connection* connection = nullptr;
        bool waits = false;
        WebRoute route = WebRoute::kPanorama;
        std::uint64_t after = 0;
        hal::Instant until{};
        Turn turn = Turn::kWaits;
    };

    WebServer(const WebServerOptions& options, const WebState& state,
              const WebRecordings& recordings);
    bool Start(const WebServerOptions& options, int listening);

    static MHD_Result OnRequest(void* self, MHD_Connection* connection, const char* url,
                                const char* method, const char* version, const char* body,
                                std::size_t* body_bytes, void** request);
    static void OnCompleted(void* self, MHD_Connection* connection, void** request,
                            MHD_RequestTerminationCode code);

    MHD_Result Answer(Request& request, std::string_view path);
    MHD_Result AnswerOrWait(Request& request);
    WebReply PageFile(MHD_Connection* connection, std::string_view name) const;
    WebReply Recording(MHD_Connection* connection, std::string_view name) const;

    [[nodiscard]] std::uint64_t SerialOfNewest(WebRoute route) const;
    [[nodiscard]] bool HasNews(const Request& request) const;
    [[nodiscard]] std::size_t CostOf(WebRoute route) const;
    /// Whether it is answered now, and how; takes its share of the budget.
    [[nodiscard]] Turn TurnOf(const Request& request);
    [[nodiscard]] WebReply News(const Request& request) const;
    void GiveTurns();

    const WebState& state_;
    const WebRecordings& recordings_;
    WebStreams streams_;
    WebBudget budget_;
    hal::Instant now_{};
    bool closing_ = false;
    int port_ = 0;
    std::deque<Request*> waiting_{};  ///< suspended ones, who came first in front
    bool somebody_is_due_ = false;    ///< among them, and the budget is used up
    MHD_Daemon* daemon_ = nullptr;
};

}  // namespace hitchview::app
