#include "app/web_stream.hpp"

#include <algorithm>

namespace hitchview::app {
namespace {

constexpr std::size_t kBlockBytes = 16 << 10;

}  // namespace

WebReply WebStreams::Open(MHD_Connection* connection) {
    auto stream = std::make_unique<Stream>();
    stream->streams = this;
    stream->connection = connection;
    MHD_Response* const response =
        MHD_create_response_from_callback(MHD_SIZE_UNKNOWN, kBlockBytes, Read, stream.get(), Free);
    if (response != nullptr) streams_.push_back(stream.release());
    WebReply reply(MHD_HTTP_OK, response);
    reply.With("Content-Type", "text/event-stream").With("Cache-Control", "no-store");
    return reply;
}

void WebStreams::Announce(hal::Instant now) {
    now_ = now;
    ++announced_;
    ResumeAll();
}

void WebStreams::Close() {
    closing_ = true;
    ResumeAll();
}

void WebStreams::ResumeAll() {
    for (Stream* const stream : streams_) {
        if (std::exchange(stream->waits, false)) MHD_resume_connection(stream->connection);
    }
}

ssize_t WebStreams::Read(void* stream, std::uint64_t, char* buffer, std::size_t room) {
    auto* const self = static_cast<Stream*>(stream);
    return self->streams->Continue(*self, buffer, room);
}

void WebStreams::Free(void* stream) {
    const std::unique_ptr<Stream> self(static_cast<Stream*>(stream));
    std::erase(self->streams->streams_, self.get());
}

ssize_t WebStreams::Continue(Stream& stream, char* buffer, std::size_t room) {
    if (closing_) return MHD_CONTENT_READER_END_OF_STREAM;
    if (!stream.text) {
        if (stream.told == announced_) {
            stream.waits = true;
            MHD_suspend_connection(stream.connection);
            return 0;
        }
        stream.told = announced_;
        stream.text = News(stream.cursor);
        stream.sent_bytes = 0;
    }
    const std::size_t count = std::min(room, stream.text->size() - stream.sent_bytes);
    std::copy_n(stream.text->data() + stream.sent_bytes, count, buffer);
    stream.sent_bytes += count;
    if (stream.sent_bytes == stream.text->size()) stream.text.reset();
    return static_cast<ssize_t>(count);
}

std::shared_ptr<const std::string> WebStreams::News(WebState::Cursor& cursor) {
    if (made_for_ != announced_ || made_from_ != cursor) {
        made_for_ = announced_;
        made_from_ = cursor;
        made_until_ = cursor;
        made_ =
            std::make_shared<const std::string>("data: " + state_.News(made_until_, now_) + "\n\n");
    }
    cursor = made_until_;
    return made_;
}

}  // namespace hitchview::app
