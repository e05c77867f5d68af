#pragma once

#include <microhttpd.h>

#include <cstdint>
#include <memory>
#include <string>
#include <vector>

#include "app/web_reply.hpp"
#include "app/web_state.hpp"

namespace hitchview::app {

/// The clients that are told the state as Server-Sent Events. One that reads slowly is told less
/// often: it has at most one message that it has not read to the end, and the next is made when it
/// is due, with what came since.
class WebStreams {
 public:
    explicit WebStreams(const WebState& state) : state_(state) {}

    /// A reply that goes on until the client leaves or Close. `connection` must be the one that it
    /// is sent to.
    WebReply Open(MHD_Connection* connection);

    /// The next message is due to all clients.
    void Announce(hal::Instant now);

    /// Ends all streams when libmicrohttpd runs next.
    void Close();

 private:
    struct Stream {
        WebStreams* streams = nullptr;
        MHD_Connection* connection = nullptr;
        WebState::Cursor cursor{};
        std::uint64_t told = 0;  ///< number of the announcement that it was told last
        bool waits = false;      ///< suspended until the next one
        std::shared_ptr<const std::string> text{};  ///< being sent
        std::size_t sent_bytes = 0;                 ///< of it
    };

    static ssize_t Read(void* stream, std::uint64_t position, char* buffer, std::size_t room);
    static void Free(void* stream);

    ssize_t Continue(Stream& stream, char* buffer, std::size_t room);
    std::shared_ptr<const std::string> News(WebState::Cursor& cursor);
    void ResumeAll();

    const WebState& state_;
    std::vector<Stream*> streams_{};  ///< owned by libmicrohttpd's responses
    std::uint64_t announced_ = 1;
    hal::Instant now_{};
    bool closing_ = false;

    /// Clients that keep up are all told the same: it is made once.
    std::uint64_t made_for_ = 0;
    WebState::Cursor made_from_{};
    WebState::Cursor made_until_{};
    std::shared_ptr<const std::string> made_{};
};

}  // namespace hitchview::app
