#include "app/web_request.hpp"

#include <arpa/inet.h>

#include <algorithm>
#include <array>
#include <charconv>
#include <utility>

namespace hitchview::app {
namespace {

constexpr std::string_view kRecordingPrefix = "/recordings/";

template <typename Int>
std::optional<Int> NumberIn(std::string_view text) {
    Int value = 0;
    const char* const last = text.data() + text.size();
    const auto [end, error] = std::from_chars(text.data(), last, value);
    if (text.empty() || error != std::errc{} || end != last) return std::nullopt;
    return value;
}

bool IsAddress(int family, std::string_view text) {
    std::array<unsigned char, sizeof(in6_addr)> address{};
    return inet_pton(family, std::string(text).c_str(), address.data()) == 1;
}

bool IsPortOrNothing(std::string_view text) {
    return text.empty() || (text.front() == ':' && NumberIn<std::uint16_t>(text.substr(1)));
}

bool IsNameCharacter(char c) {
    return (c >= 'a' && c <= 'z') || (c >= 'A' && c <= 'Z') || (c >= '0' && c <= '9') ||
           std::string_view("._-+").find(c) != std::string_view::npos;
}

/// The last bytes of a file: `-500`.
WebRangeAnswer AnswerSuffix(std::string_view text, std::uint64_t size_bytes) {
    const auto asked = NumberIn<std::uint64_t>(text);
    if (!asked) return {};
    const std::uint64_t count = std::min(*asked, size_bytes);
    if (count == 0) return {WebRangeKind::kOutside, {}};
    return {WebRangeKind::kPart, {size_bytes - count, count}};
}

}  // namespace

WebTarget TargetOf(std::string_view path) {
    using Route = std::pair<std::string_view, WebRoute>;
    constexpr std::array<Route, 5> kRoutes{{{"/events", WebRoute::kEvents},
                                            {"/panorama.jpg", WebRoute::kPanorama},
                                            {"/previews", WebRoute::kPreviews},
                                            {"/overlay", WebRoute::kOverlay},
                                            {"/recordings", WebRoute::kRecordings}}};
    const auto* const route = std::ranges::find(kRoutes, path, &Route::first);
    if (route != kRoutes.end()) return {route->second, {}};
    if (path.starts_with(kRecordingPrefix)) {
        return {WebRoute::kRecordingFile, path.substr(kRecordingPrefix.size())};
    }
    const std::string_view file = path.empty() ? path : path.substr(1);
    return {WebRoute::kPageFile, file.empty() ? "index.html" : file};
}

bool IsOwnHost(std::string_view host) {
    if (host.starts_with('[')) {
        const std::size_t end = host.find(']');
        return end != std::string_view::npos && IsAddress(AF_INET6, host.substr(1, end - 1)) &&
               IsPortOrNothing(host.substr(end + 1));
    }
    const std::size_t colon = std::min(host.find(':'), host.size());
    const std::string_view name = host.substr(0, colon);
    return (name == "localhost" || IsAddress(AF_INET, name)) && IsPortOrNothing(host.substr(colon));
}

std::uint64_t SerialOf(std::string_view text) {
    return NumberIn<std::uint64_t>(text).value_or(0);
}

WebRangeAnswer AnswerRange(std::string_view header, std::uint64_t size_bytes) {
    constexpr std::string_view kUnit = "bytes=";
    const std::size_t dash = header.find('-');
    if (!header.starts_with(kUnit) || dash == std::string_view::npos) return {};
    const std::string_view from = header.substr(kUnit.size(), dash - kUnit.size());
    const std::string_view until = header.substr(dash + 1);
    if (from.empty()) return AnswerSuffix(until, size_bytes);
    const auto first = NumberIn<std::uint64_t>(from);
    const auto last = until.empty() ? std::optional(UINT64_MAX) : NumberIn<std::uint64_t>(until);
    if (!first || !last || *last < *first) return {};
    if (*first >= size_bytes) return {WebRangeKind::kOutside, {}};
    return {WebRangeKind::kPart, {*first, std::min(*last, size_bytes - 1) - *first + 1}};
}

bool IsRecordingName(std::string_view name) {
    constexpr std::size_t kLongest = 128;
    return name.size() <= kLongest && name.ends_with(".lcm") && !name.starts_with('.') &&
           std::ranges::all_of(name, IsNameCharacter);
}

}  // namespace hitchview::app
