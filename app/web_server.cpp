#include "app/web_server.hpp"

#include <unistd.h>

#include <algorithm>
#include <optional>
#include <utility>

#include "app/web_listen.hpp"
#include "app/web_page_files.hpp"

namespace hitchview::app {
namespace {

using hal::Checked;
using hal::Instant;
using std::chrono::milliseconds;

/// Request line and headers; more is refused by libmicrohttpd (414, 431).
constexpr std::size_t kConnectionBytes = 16 << 10;
/// A client that neither sends nor takes a byte for so long is closed.
constexpr unsigned kIdleSeconds = 10;
/// Then a client that waits is told that there is nothing: it asks again.
constexpr milliseconds kLongestWait{1000};
/// Eight thumbnails of 192x108.
constexpr std::size_t kUsualPreviewsBytes = 48 << 10;

std::string_view Header(MHD_Connection* connection, const char* name) {
    const char* const value = MHD_lookup_connection_value(connection, MHD_HEADER_KIND, name);
    return value != nullptr ? value : std::string_view{};
}

std::string_view Argument(MHD_Connection* connection, const char* name) {
    const char* const value = MHD_lookup_connection_value(connection, MHD_GET_ARGUMENT_KIND, name);
    return value != nullptr ? value : std::string_view{};
}

/// What is refused before anything is looked up; the connection is then closed.
std::optional<WebReply> Refusal(MHD_Connection* connection, std::string_view method) {
    if (method != "GET" && method != "HEAD") {
        return std::move(WebReply::Text(MHD_HTTP_METHOD_NOT_ALLOWED, "only GET and HEAD")
                             .With("Allow", "GET, HEAD"));
    }
    if (!IsOwnHost(Header(connection, "Host"))) {
        return WebReply::Text(MHD_HTTP_MISDIRECTED_REQUEST,
                              "call this server by its address or as localhost");
    }
    const std::string_view length = Header(connection, "Content-Length");
    const bool has_body = !length.empty() && length != "0";
    if (has_body || !Header(connection, "Transfer-Encoding").empty()) {
        return WebReply::Text(MHD_HTTP_BAD_REQUEST, "a request has no body here");
    }
    return std::nullopt;
}

bool Waits(WebRoute route) {
    return route == WebRoute::kPanorama || route == WebRoute::kPreviews ||
           route == WebRoute::kOverlay;
}

}  // namespace

Checked<std::unique_ptr<WebServer>> WebServer::Create(const WebServerOptions& options,
                                                      const WebState& state,
                                                      const WebRecordings& recordings) {
    const auto listening = Listen(options.address, options.port);
    if (!listening) return listening.error();
    std::unique_ptr<WebServer> server(new WebServer(options, state, recordings));
    server->port_ = listening.value().port;
    if (server->Start(options, listening.value().descriptor)) return server;
    close(listening.value().descriptor);
    return std::string("libmicrohttpd did not start");
}

WebServer::WebServer(const WebServerOptions& options, const WebState& state,
                     const WebRecordings& recordings)
    : state_(state), recordings_(recordings), streams_(state), budget_(options.bytes_per_s) {}

bool WebServer::Start(const WebServerOptions& options, int listening) {
    daemon_ = MHD_start_daemon(
        MHD_USE_EPOLL | MHD_ALLOW_SUSPEND_RESUME, 0, nullptr, nullptr, OnRequest, this,
        MHD_OPTION_LISTEN_SOCKET, listening, MHD_OPTION_CONNECTION_LIMIT,
        static_cast<unsigned>(options.connections), MHD_OPTION_CONNECTION_MEMORY_LIMIT,
        kConnectionBytes, MHD_OPTION_CONNECTION_TIMEOUT, kIdleSeconds,
        MHD_OPTION_SIGPIPE_HANDLED_BY_APP, 1, MHD_OPTION_NOTIFY_COMPLETED, OnCompleted, this,
        MHD_OPTION_END);
    return daemon_ != nullptr;
}

WebServer::~WebServer() {
    if (daemon_ == nullptr) return;
    closing_ = true;
    streams_.Close();
    GiveTurns();
    MHD_run(daemon_);  // those that were suspended must go on before the end
    MHD_stop_daemon(daemon_);
}

int WebServer::descriptor() const {
    return MHD_get_daemon_info(daemon_, MHD_DAEMON_INFO_EPOLL_FD)->epoll_fd;
}

milliseconds WebServer::Patience(milliseconds longest) const {
    MHD_UNSIGNED_LONG_LONG timeout_ms = 0;
    if (MHD_get_timeout(daemon_, &timeout_ms) != MHD_YES) return longest;
    return milliseconds(std::min(timeout_ms, static_cast<MHD_UNSIGNED_LONG_LONG>(longest.count())));
}

void WebServer::Serve(Instant now) {
    now_ = now;
    GiveTurns();
    MHD_run(daemon_);
}

MHD_Result WebServer::OnRequest(void* self, MHD_Connection* connection, const char* url,
                                const char* method, const char*, const char*, std::size_t*,
                                void** state) {
    auto* const server = static_cast<WebServer*>(self);
    auto* const request = static_cast<Request*>(*state);
    if (request == nullptr) {
        if (const auto refused = Refusal(connection, method)) return refused->Send(connection);
        // An answer at this first call would close the connection behind it.
        *state = new Request{.connection = connection};
        return MHD_YES;
    }
    return request->waits ? server->AnswerOrWait(*request) : server->Answer(*request, url);
}

void WebServer::OnCompleted(void*, MHD_Connection*, void** state, MHD_RequestTerminationCode) {
    const std::unique_ptr<Request> done(static_cast<Request*>(*state));
    *state = nullptr;
}

MHD_Result WebServer::Answer(Request& request, std::string_view path) {
    MHD_Connection* const connection = request.connection;
    const WebTarget target = TargetOf(path);
    const bool link_from_elsewhere = Header(connection, "Sec-Fetch-Site") == "cross-site";
    if (link_from_elsewhere && target.route != WebRoute::kPageFile) {
        return WebReply::Text(MHD_HTTP_FORBIDDEN, "not for pages of others").Send(connection);
    }
    if (Waits(target.route)) {
        request.waits = true;
        request.route = target.route;
        request.after = SerialOf(Argument(connection, "after"));
        request.until = now_ + kLongestWait;
        return AnswerOrWait(request);
    }
    if (target.route == WebRoute::kEvents) return streams_.Open(connection).Send(connection);
    if (target.route == WebRoute::kRecordings) {
        return WebReply::Json(recordings_.List()).Send(connection);
    }
    if (target.route == WebRoute::kRecordingFile) {
        return Recording(connection, target.name).Send(connection);
    }
    return PageFile(connection, target.name).Send(connection);
}

WebReply WebServer::PageFile(MHD_Connection* connection, std::string_view name) const {
    const auto files = WebPageFiles();
    const auto file = std::ranges::find(files, name, &WebPageFile::name);
    if (file == files.end()) return WebReply::Text(MHD_HTTP_NOT_FOUND, "nothing here");
    return WebReply::PageFile(*file, Header(connection, "If-None-Match"));
}

WebReply WebServer::Recording(MHD_Connection* connection, std::string_view name) const {
    const auto recording = recordings_.Open(name);
    if (!recording) return WebReply::Text(MHD_HTTP_NOT_FOUND, "no such recording");
    return WebReply::Recording(recording.value(), Header(connection, "Range"),
                               Header(connection, "If-Range"));
}

std::uint64_t WebServer::SerialOfNewest(WebRoute route) const {
    if (route == WebRoute::kPreviews) return state_.pictures().newest_preview();
    if (route == WebRoute::kOverlay) return state_.overlay_serial();
    return state_.pictures().panorama().serial;
}

bool WebServer::HasNews(const Request& request) const {
    const std::uint64_t newest = SerialOfNewest(request.route);
    if (newest == 0 || newest == request.after) return false;
    return request.route != WebRoute::kPanorama ||
           now_ - state_.pictures().panorama().arrived_at <= kWebPictureStaleAfter;
}

std::size_t WebServer::CostOf(WebRoute route) const {
    if (route == WebRoute::kPanorama) return state_.pictures().panorama().jpeg->size();
    return route == WebRoute::kOverlay ? state_.overlay().size() : kUsualPreviewsBytes;
}

WebReply WebServer::News(const Request& request) const {
    const std::uint64_t newest = SerialOfNewest(request.route);
    if (closing_ || request.turn != Turn::kNews || !HasNews(request)) {
        return WebReply::Nothing(newest);
    }
    if (request.route == WebRoute::kPanorama) {
        return WebReply::Picture(state_.pictures().panorama(), now_);
    }
    // A server that was started anew counts from one again.
    const std::uint64_t after = request.after <= newest ? request.after : 0;
    WebReply reply = request.route == WebRoute::kOverlay
                         ? WebReply::Json(state_.overlay())
                         : WebReply::Bytes(state_.pictures().PreviewsAfter(after, now_),
                                           "application/octet-stream");
    reply.With("X-Serial", std::to_string(newest));
    return reply;
}

WebServer::Turn WebServer::TurnOf(const Request& request) {
    if (closing_ || now_ >= request.until) return Turn::kNothing;
    if (!HasNews(request)) return Turn::kWaits;
    if (budget_.Take(CostOf(request.route), now_)) return Turn::kNews;
    somebody_is_due_ = true;
    return Turn::kWaits;
}

MHD_Result WebServer::AnswerOrWait(Request& request) {
    // Nobody overtakes those who wait for their share of the budget.
    if (request.turn == Turn::kWaits && !somebody_is_due_) request.turn = TurnOf(request);
    if (closing_ || request.turn != Turn::kWaits) return News(request).Send(request.connection);
    waiting_.push_back(&request);
    MHD_suspend_connection(request.connection);
    return MHD_YES;
}

void WebServer::GiveTurns() {
    somebody_is_due_ = false;
    std::erase_if(waiting_, [&](Request* request) {
        request->turn = TurnOf(*request);
        if (request->turn != Turn::kWaits) MHD_resume_connection(request->connection);
        return request->turn != Turn::kWaits;
    });
}

}  // namespace hitchview::app
