#include "app/web_reply.hpp"

#include <unistd.h>

#include <array>
#include <utility>

namespace hitchview::app {
namespace {

using Header = std::pair<const char*, const char*>;

/// Nothing from elsewhere is loaded, nothing in the page's text is run, nobody frames it, and pages
/// of others cannot read what we answer.
constexpr std::array<Header, 6> kHeaders{{
    {"Content-Security-Policy",
     "default-src 'none'; script-src 'self'; style-src 'self'; img-src 'self' blob:; "
     "connect-src 'self'; base-uri 'none'; form-action 'none'; frame-ancestors 'none'"},
    {"X-Content-Type-Options", "nosniff"},
    {"X-Frame-Options", "DENY"},
    {"Referrer-Policy", "no-referrer"},
    {"Cross-Origin-Resource-Policy", "same-origin"},
    {"Cross-Origin-Opener-Policy", "same-origin"},
}};

/// A response that keeps `owner` until it was sent to the last who gets it.
template <typename Owner>
MHD_Response* ResponseOf(Owner owner, const void* bytes, std::size_t count) {
    if (count == 0) return MHD_create_response_from_buffer(0, nullptr, MHD_RESPMEM_PERSISTENT);
    auto kept = std::make_unique<Owner>(std::move(owner));
    const MHD_IoVec content{bytes, count};
    MHD_Response* const response = MHD_create_response_from_iovec(
        &content, 1, [](void* owned) { delete static_cast<Owner*>(owned); }, kept.get());
    if (response != nullptr) (void)kept.release();
    return response;
}

/// Moved strings and vectors keep their bytes where they are only on the heap.
template <typename Content>
MHD_Response* ResponseOwning(Content content) {
    auto owner = std::make_shared<const Content>(std::move(content));
    const void* const bytes = owner->data();
    const std::size_t count = owner->size();
    return ResponseOf(std::move(owner), bytes, count);
}

std::string RangeText(const WebRange& range, std::uint64_t size_bytes) {
    return "bytes " + std::to_string(range.first) + '-' +
           std::to_string(range.first + range.count - 1) + '/' + std::to_string(size_bytes);
}

}  // namespace

WebReply::WebReply(unsigned status, MHD_Response* response) : status_(status), response_(response) {
    for (const auto& [name, value] : kHeaders) With(name, value);
}

WebReply& WebReply::With(const char* header, const std::string& value) {
    if (response_) MHD_add_response_header(response_.get(), header, value.c_str());
    return *this;
}

MHD_Result WebReply::Send(MHD_Connection* connection) const {
    return response_ ? MHD_queue_response(connection, status_, response_.get()) : MHD_NO;
}

WebReply WebReply::Text(unsigned status, std::string_view text) {
    WebReply reply(status, ResponseOwning(std::string(text) + '\n'));
    reply.With("Content-Type", "text/plain; charset=utf-8").With("Cache-Control", "no-store");
    return reply;
}

WebReply WebReply::Json(std::string text) {
    WebReply reply(MHD_HTTP_OK, ResponseOwning(std::move(text)));
    reply.With("Content-Type", "application/json").With("Cache-Control", "no-store");
    return reply;
}

WebReply WebReply::Bytes(std::vector<std::uint8_t> bytes, const char* type) {
    WebReply reply(MHD_HTTP_OK, ResponseOwning(std::move(bytes)));
    reply.With("Content-Type", type).With("Cache-Control", "no-store");
    return reply;
}

WebReply WebReply::Picture(const WebPicture& picture, hal::Instant now) {
    const auto age =
        std::chrono::duration_cast<std::chrono::milliseconds>(now - picture.arrived_at);
    WebReply reply(MHD_HTTP_OK,
                   ResponseOf(picture.jpeg, picture.jpeg->data(), picture.jpeg->size()));
    reply.With("Content-Type", "image/jpeg")
        .With("Cache-Control", "no-store")
        .With("X-Serial", std::to_string(picture.serial))
        .With("X-Sequence", std::to_string(picture.sequence))
        .With("X-Age-Ms", std::to_string(age.count()));
    return reply;
}

WebReply WebReply::Nothing(std::uint64_t serial) {
    WebReply reply(MHD_HTTP_NO_CONTENT, ResponseOf(0, nullptr, 0));
    reply.With("Cache-Control", "no-store").With("X-Serial", std::to_string(serial));
    return reply;
}

WebReply WebReply::PageFile(const WebPageFile& file, std::string_view known_tag) {
    const bool known = known_tag == file.tag;
    WebReply reply(known ? MHD_HTTP_NOT_MODIFIED : MHD_HTTP_OK,
                   ResponseOf(0, file.content.data(), known ? 0 : file.content.size()));
    reply.With("Content-Type", std::string(file.type))
        .With("Cache-Control", "no-cache")
        .With("ETag", std::string(file.tag));
    return reply;
}

WebReply WebReply::Recording(const WebRecording& recording, std::string_view range,
                             std::string_view range_tag) {
    const bool same = range_tag.empty() || range_tag == recording.tag;
    const WebRangeAnswer answer =
        same ? AnswerRange(range, recording.size_bytes) : WebRangeAnswer{};
    if (answer.kind == WebRangeKind::kOutside) {
        close(recording.descriptor);
        WebReply reply = Text(MHD_HTTP_RANGE_NOT_SATISFIABLE, "the file is shorter");
        reply.With("Content-Range", "bytes */" + std::to_string(recording.size_bytes));
        return reply;
    }
    const bool part = answer.kind == WebRangeKind::kPart;
    const WebRange sent = part ? answer.range : WebRange{0, recording.size_bytes};
    WebReply reply(
        part ? MHD_HTTP_PARTIAL_CONTENT : MHD_HTTP_OK,
        MHD_create_response_from_fd_at_offset64(sent.count, recording.descriptor, sent.first));
    if (!reply.response_) close(recording.descriptor);
    reply.With("Content-Type", "application/octet-stream")
        .With("Content-Disposition", "attachment")
        .With("Cache-Control", "no-store")
        .With("Accept-Ranges", "bytes")
        .With("ETag", recording.tag);
    if (part) reply.With("Content-Range", RangeText(sent, recording.size_bytes));
    return reply;
}

}  // namespace hitchview::app
