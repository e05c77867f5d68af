#pragma once

#include <microhttpd.h>

#include <memory>
#include <string>
#include <string_view>
#include <vector>

#include "app/web_page_files.hpp"
#include "app/web_pictures.hpp"
#include "app/web_recordings.hpp"
#include "app/web_request.hpp"

namespace hitchview::app {

/// An answer that has not been sent: status and response of libmicrohttpd with the headers that
/// each answer has. A null response where memory ran out: the connection is then closed.
class WebReply {
 public:
    /// Takes over `response`.
    WebReply(unsigned status, MHD_Response* response);

    /// Plain text for a person who looks at the answer alone.
    static WebReply Text(unsigned status, std::string_view text);
    static WebReply Json(std::string text);
    static WebReply Bytes(std::vector<std::uint8_t> bytes, const char* type);
    static WebReply Picture(const WebPicture& picture, hal::Instant now);
    static WebReply Nothing(std::uint64_t serial);
    static WebReply PageFile(const WebPageFile& file, std::string_view known_tag);
    /// The part of it that `range` (header Range) asks for; closes its descriptor.
    static WebReply Recording(const WebRecording& recording, std::string_view range,
                              std::string_view range_tag);

    WebReply& With(const char* header, const std::string& value);

    /// Hands it to the connection.
    MHD_Result Send(MHD_Connection* connection) const;

 private:
    struct Deleter {
        void operator()(MHD_Response* response) const { MHD_destroy_response(response); }
    };

    unsigned status_;
    std::unique_ptr<MHD_Response, Deleter> response_;
};

}  // namespace hitchview::app
