#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <string_view>

namespace hitchview::app {

enum class WebRoute {
    kPageFile,       ///< part of the page; `name`: without the leading slash
    kEvents,         ///< state, as Server-Sent Events
    kPanorama,       ///< newest panorama behind the one that the client has
    kPreviews,       ///< newest thumbnails behind those that the client has
    kOverlay,        ///< newest overlay behind the one that the client has
    kRecordings,     ///< list of recordings
    kRecordingFile,  ///< one of them; `name`
};

struct WebTarget {
    WebRoute route = WebRoute::kPageFile;
    std::string_view name{};
};

/// What a decoded path asks for, without a look at what there is.
WebTarget TargetOf(std::string_view path);

/// Whether `Host:` names this server by address or as localhost. A page of someone else whose name
/// was made to resolve to our address (DNS rebinding) names it otherwise.
bool IsOwnHost(std::string_view host);

/// The number in a client's `after=`; 0 unless it is one.
std::uint64_t SerialOf(std::string_view text);

/// Bytes of a file that a client asks for.
struct WebRange {
    std::uint64_t first = 0;
    std::uint64_t count = 0;
};

enum class WebRangeKind { kWhole, kPart, kOutside };

struct WebRangeAnswer {
    WebRangeKind kind = WebRangeKind::kWhole;
    WebRange range{};
};

/// What `Range:` means for a file of this size (RFC 9110, section 14). Several ranges and what is
/// not understood are answered by the whole file, as the standard allows.
WebRangeAnswer AnswerRange(std::string_view header, std::uint64_t size_bytes);

/// A recording may be called this: 1 to 128 of A-Z a-z 0-9 . _ - +, not a dot first, `.lcm` last.
bool IsRecordingName(std::string_view name);

}  // namespace hitchview::app
