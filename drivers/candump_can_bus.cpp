#include "drivers/candump_can_bus.hpp"

#include <algorithm>
#include <array>
#include <bit>
#include <charconv>
#include <fstream>
#include <optional>
#include <system_error>
#include <utility>

namespace hitchview::drivers {
namespace {

using hal::CanFrame;
using hal::CanFrameKind;
using hal::Checked;
using hal::Done;
using hal::Instant;

constexpr std::uint32_t kLargestStandardId = 0x7ff;
constexpr std::uint32_t kLargestExtendedId = 0x1fffffff;
constexpr std::uint32_t kErrorFlag = 0x20000000;
constexpr std::uint64_t kLargestSecond = 9'000'000'000;  // of those whose nanoseconds fit 63 bits
constexpr std::uint64_t kNanosecondsPerSecond = 1'000'000'000;
constexpr std::size_t kLargestClassicSize = 8;

struct Line {
    std::string_view interface;
    CanFrame frame{};  // received_at is the time in the log
};

std::string Wrong(const char* what, std::string_view text, const std::string& rule) {
    constexpr std::size_t kLongestShown = 80;
    const std::string shown(text.substr(0, kLongestShown));
    return std::string(what) + " is '" + shown + "', must be " + rule;
}

// The text before `end`, taken off `rest` together with it; all of `rest` where there is no `end`.
std::string_view TakeUntil(char end, std::string_view& rest) {
    const std::size_t length = std::min(rest.find(end), rest.size());
    const std::string_view taken = rest.substr(0, length);
    rest.remove_prefix(std::min(length + 1, rest.size()));
    return taken;
}

// Empty unless all of `text` is one number of that base, without sign or prefix.
std::optional<std::uint64_t> Number(std::string_view text, int base) {
    std::uint64_t number = 0;
    const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), number, base);
    if (error != std::errc{} || end != text.data() + text.size()) return std::nullopt;
    return number;
}

Checked<Instant> ParseTime(std::string_view text) {
    std::string_view decimals = text;
    const auto seconds = Number(TakeUntil('.', decimals), 10);
    const auto fraction = Number(decimals, 10);
    const bool micros = decimals.size() == 6;
    const bool known = seconds && fraction && (micros || decimals.size() == 9);
    if (!known || *seconds > kLargestSecond) {
        return Wrong("time", text, "seconds from 0 to 9000000000 with 6 or 9 decimals");
    }
    const std::uint64_t rest_ns = *fraction * (micros ? 1000 : 1);
    return Instant(static_cast<Instant::rep>(*seconds * kNanosecondsPerSecond + rest_ns));
}

Checked<Done> ParseId(std::string_view text, Line& line) {
    const auto maybe_id = Number(text, 16);
    line.frame.extended = text.size() == 8;
    if (!maybe_id || (!line.frame.extended && text.size() != 3)) {
        return Wrong("id", text, "3 hex digits (standard) or 8 (extended)");
    }
    line.frame.id = static_cast<std::uint32_t>(*maybe_id);
    if (line.frame.extended && std::bit_floor(line.frame.id) == kErrorFlag) {
        line.frame.kind = CanFrameKind::kError;
        line.frame.id -= kErrorFlag;
    } else if (line.frame.id > (line.frame.extended ? kLargestExtendedId : kLargestStandardId)) {
        return Wrong("id", text,
                     "at most 7FF, or with 8 digits at most 1FFFFFFF (error: 3FFFFFFF)");
    }
    return Done{};
}

// The bytes that are asked for; empty where it is no remote frame.
std::optional<std::uint8_t> RemoteSize(std::string_view data) {
    if (data == "R") return std::uint8_t{0};
    const bool is_remote = data.size() == 2 && data[0] == 'R' && data[1] >= '0' && data[1] <= '8';
    return is_remote ? std::optional<std::uint8_t>(data[1] - '0') : std::nullopt;
}

bool IsFdSize(std::size_t bytes) {
    constexpr std::array<std::size_t, 7> kLarge{12, 16, 20, 24, 32, 48, 64};
    return bytes <= kLargestClassicSize || std::ranges::find(kLarge, bytes) != kLarge.end();
}

Checked<Done> ParseBytes(std::string_view text, CanFrame& frame) {
    for (std::size_t i = 0; i < text.size() / 2; ++i) {
        const auto maybe_byte = Number(text.substr(2 * i, 2), 16);
        if (!maybe_byte) return Wrong("data", text, "hex digits only");
        frame.data[i] = static_cast<std::uint8_t>(*maybe_byte);
    }
    frame.size_bytes = static_cast<std::uint8_t>(text.size() / 2);
    return Done{};
}

Checked<Done> ParseFdData(std::string_view text, CanFrame& frame) {
    const auto maybe_flags = Number(text.substr(0, 1), 16);
    if (!maybe_flags) return Wrong("flags of FD frame", text, "one hex digit");
    frame.fd = true;
    frame.fd_flags = static_cast<std::uint8_t>(*maybe_flags);
    const std::string_view data = text.substr(1);
    if (data.size() % 2 != 0 || !IsFdSize(data.size() / 2)) {
        return Wrong("data of FD frame", data, "0 to 8, 12, 16, 20, 24, 32, 48 or 64 whole bytes");
    }
    return ParseBytes(data, frame);
}

Checked<Done> ParseData(std::string_view text, Line& line) {
    if (text.starts_with('#')) return ParseFdData(text.substr(1), line.frame);
    if (const auto maybe_size = RemoteSize(text)) {
        if (line.frame.kind == CanFrameKind::kData) line.frame.kind = CanFrameKind::kRemote;
        line.frame.size_bytes = *maybe_size;
        return Done{};
    }
    if (text.size() % 2 != 0 || text.size() / 2 > kLargestClassicSize) {
        return Wrong("data", text, "0 to 8 whole bytes in hex, R or R0 to R8");
    }
    return ParseBytes(text, line.frame);
}

std::string_view WithoutDirection(std::string_view text) {
    const bool has_one = text.ends_with(" R") || text.ends_with(" T");
    return has_one ? text.substr(0, text.size() - 2) : text;
}

Checked<Line> ParseLine(std::string_view text) {
    constexpr const char* kForm = "(seconds) interface id#data";
    std::string_view rest = WithoutDirection(text);
    if (!rest.starts_with('(') || rest.find(") ") == rest.npos) return Wrong("line", text, kForm);
    rest.remove_prefix(1);
    const auto time = ParseTime(TakeUntil(')', rest));
    if (!time) return time.error();
    // candump pads the names of interfaces to one width.
    rest.remove_prefix(std::min(rest.find_first_not_of(' '), rest.size()));

    Line line{.interface = TakeUntil(' ', rest)};
    line.frame.received_at = time.value();
    if (line.interface.empty() || rest.find('#') == rest.npos) return Wrong("line", text, kForm);
    if (auto id = ParseId(TakeUntil('#', rest), line); !id) return id.error();
    if (auto data = ParseData(rest, line); !data) return data.error();
    return line;
}

// Reads the file into `text`, which takes its memory once.
Checked<Done> ReadText(const std::filesystem::path& file, std::string& text) {
    std::error_code error;
    const std::uintmax_t bytes = std::filesystem::file_size(file, error);
    if (error) return file.string() + ": " + error.message();
    if (bytes > CandumpCanBus::kMaxBytes) {
        return file.string() + ": has " + std::to_string(bytes) + " bytes, must be at most " +
               std::to_string(CandumpCanBus::kMaxBytes);
    }
    text.resize(bytes);
    std::ifstream stream(file, std::ios::binary);
    if (stream.read(text.data(), static_cast<std::streamsize>(bytes))) return Done{};
    return file.string() + ": cannot be read";
}

void Count(CanFrameKind kind, CandumpCanBus::LogCounts& counts) {
    switch (kind) {
        case CanFrameKind::kData:
            ++counts.data;
            break;
        case CanFrameKind::kRemote:
            ++counts.remote;
            break;
        case CanFrameKind::kError:
            ++counts.error;
            break;
    }
}

}  // namespace

Checked<std::unique_ptr<CandumpCanBus>> CandumpCanBus::Open(const std::filesystem::path& file,
                                                            Instant start, Kinds kinds) {
    std::string text;
    if (auto read = ReadText(file, text); !read) return read.error();
    return Parse(std::move(text), file.string(), start, kinds);
}

Checked<std::unique_ptr<CandumpCanBus>> CandumpCanBus::Parse(std::string text,
                                                             const std::string& name, Instant start,
                                                             Kinds kinds) {
    std::unique_ptr<CandumpCanBus> self(new CandumpCanBus(std::move(text), kinds));
    if (auto checked = self->Check(name, start); !checked) return checked.error();
    return self;
}

Checked<Done> CandumpCanBus::Check(const std::string& file, Instant start) {
    std::string_view rest = text_;
    std::string_view interface;
    const auto at = [&](int number) { return file + ":" + std::to_string(number) + ": "; };
    for (int number = 1; !rest.empty(); ++number) {
        const Checked<Line> line = ParseLine(TakeUntil('\n', rest));
        if (!line) return at(number) + line.error();
        if (number == 1) {
            interface = line.value().interface;
            log_to_ours_ = start - line.value().frame.received_at;
        }
        if (line.value().interface != interface) {
            return at(number) + Wrong("interface", line.value().interface,
                                      std::string(interface) + " as in line 1");
        }
        Count(line.value().frame.kind, log_counts_);
    }
    return Done{};
}

hal::Result<CanFrame> CandumpCanBus::DoWaitFrame(std::chrono::milliseconds /*timeout*/) {
    while (!rest_.empty()) {
        Line line = ParseLine(TakeUntil('\n', rest_)).value();  // Open has checked every line
        if (line.frame.kind != CanFrameKind::kData && kinds_ == Kinds::kData) continue;
        ++delivered_;
        line.frame.epoch = line.frame.received_at;
        line.frame.received_at += log_to_ours_;
        return line.frame;
    }
    return hal::Error::kEndOfStream;
}

hal::CanCounts CandumpCanBus::DoCounts() const {
    return {.delivered = delivered_, .errors = log_counts_.error};
}

}  // namespace hitchview::drivers
