#include "drivers/lcm_url.hpp"

#include <algorithm>
#include <array>
#include <charconv>
#include <optional>

namespace hitchview::drivers {
namespace {

using hal::Checked;
using hal::Done;

constexpr std::string_view kReceiveBufferKey = "recv_buf_size";

std::string Quoted(std::string_view text) {
    return std::string("'").append(text).append("'");
}

/// The text up to the separator; `rest` loses it and the separator.
std::string_view TakeUntil(char separator, std::string_view& rest) {
    const auto end = std::min(rest.find(separator), rest.size());
    const std::string_view taken = rest.substr(0, end);
    rest.remove_prefix(std::min(end + 1, rest.size()));
    return taken;
}

std::optional<int> ParseInt(std::string_view text) {
    int value = 0;
    const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), value);
    if (text.empty() || error != std::errc{} || end != text.data() + text.size()) return {};
    return value;
}

Checked<Done> CheckInt(std::string_view key, std::string_view text, int lowest, int highest) {
    const std::optional<int> maybe_value = ParseInt(text);
    if (maybe_value && *maybe_value >= lowest && *maybe_value <= highest) return Done{};
    return std::string(key) + " is " + Quoted(text) + ", must be " + std::to_string(lowest) +
           " to " + std::to_string(highest);
}

bool IsMulticastAddress(std::string_view address) {
    std::array<int, 4> bytes{};
    for (int& byte : bytes) {
        byte = ParseInt(TakeUntil('.', address)).value_or(-1);
        if (byte < 0 || byte > 255) return false;
    }
    return address.empty() && bytes[0] >= 224 && bytes[0] <= 239;
}

Checked<Done> CheckOption(std::string_view option) {
    const std::string_view key = TakeUntil('=', option);
    if (key == "ttl") return CheckInt(key, option, 0, 255);
    if (key == kReceiveBufferKey) return CheckInt(key, option, 4096, 256 << 20);
    if (key == "transmit_only" && (option == "true" || option == "false")) return Done{};
    return "option " + Quoted(key) + " with value " + Quoted(option) +
           " is not known, must be ttl, recv_buf_size or transmit_only=true|false";
}

Checked<Done> CheckMulticast(std::string_view network) {
    std::string_view options = network;
    std::string_view host = TakeUntil('?', options);
    const std::string_view address = TakeUntil(':', host);
    if (!IsMulticastAddress(address)) {
        return "address is " + Quoted(address) + ", must be 224.0.0.0 to 239.255.255.255";
    }
    if (auto port = CheckInt("port", host, 1, 65535); !port) return port;
    while (!options.empty()) {
        if (auto option = CheckOption(TakeUntil('&', options)); !option) return option;
    }
    return Done{};
}

bool IsMulticast(std::string_view scheme) {
    return scheme == "udpm" || scheme == "mpudpm";
}

Checked<Done> CheckParts(std::string_view url) {
    constexpr std::string_view kMark = "://";
    const auto end = url.find(kMark);
    const std::string_view scheme = url.substr(0, end);
    constexpr std::array<std::string_view, 3> kOthers{"file", "memq", "tcpq"};
    const bool other = std::find(kOthers.begin(), kOthers.end(), scheme) != kOthers.end();
    if (end == std::string_view::npos || !(other || IsMulticast(scheme))) {
        return "scheme is " + Quoted(scheme) + ", must be udpm, mpudpm, file, memq or tcpq";
    }
    return other ? Checked<Done>(Done{}) : CheckMulticast(url.substr(end + kMark.size()));
}

}  // namespace

Checked<Done> CheckLcmUrl(std::string_view url) {
    Checked<Done> result = CheckParts(url);
    return result ? result : "LCM URL " + Quoted(url) + ": " + result.error();
}

bool IsMulticastUrl(std::string_view url) {
    return IsMulticast(url.substr(0, url.find(':')));
}

Checked<Done> CheckLcmChannel(std::string_view key, std::string_view channel) {
    constexpr std::size_t kLongest = 63;
    const auto allowed = [](char c) {
        return (c >= 'A' && c <= 'Z') || (c >= 'a' && c <= 'z') || (c >= '0' && c <= '9') ||
               c == '_';
    };
    const bool right_length = !channel.empty() && channel.size() <= kLongest;
    if (right_length && std::all_of(channel.begin(), channel.end(), allowed)) return Done{};
    return std::string(key) + " is " + Quoted(channel) +
           ", must be 1 to 63 characters of A-Z, a-z, 0-9 and _";
}

std::string WithReceiveBuffer(const std::string& url, int bytes) {
    if (!IsMulticastUrl(url) || url.find(kReceiveBufferKey) != std::string::npos) return url;
    const char separator = url.find('?') == std::string::npos ? '?' : '&';
    return url + separator + std::string(kReceiveBufferKey) + '=' + std::to_string(bytes);
}

}  // namespace hitchview::drivers
