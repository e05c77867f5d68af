#include "drivers/lcm_log_reader.hpp"

#include <algorithm>
#include <cstdlib>

namespace hitchview::drivers {
namespace {

using hal::Done;
using hal::Error;
using hal::Result;

constexpr std::int64_t kMostDisorder_us = 1'000'000;

/// Of neighbouring events: wide enough for a pause, and only one of 10^12 random times is so near.
bool AreNear(std::int64_t one_us, std::int64_t other_us) {
    constexpr std::uint64_t kNear_us = 10'000'000;
    const auto apart = static_cast<std::uint64_t>(one_us) - static_cast<std::uint64_t>(other_us);
    return std::min(apart, -apart) <= kNear_us;
}

bool IsPrintable(std::uint8_t byte) {
    return byte >= 0x20 && byte < 0x7F;
}

/// How far a number is behind another; huge if it is before it.
std::uint64_t NumbersFrom(std::int64_t early, std::int64_t late) {
    return static_cast<std::uint64_t>(late) - static_cast<std::uint64_t>(early);
}

/// Of events: a header and one character of a channel.
std::uint64_t MostEventsIn(std::uint64_t bytes) {
    return bytes / (kLcmLogHeaderBytes + 1) + 1;
}

}  // namespace

hal::Checked<std::unique_ptr<LcmLogReader>> LcmLogReader::Open(const std::filesystem::path& file,
                                                               const LcmLogReaderOptions& options) {
    HV_EXPECT(options.max_data_bytes > 0);
    auto window = LcmLogWindow::Open(file.string());
    if (!window) return window.error();
    return std::unique_ptr<LcmLogReader>(new LcmLogReader(std::move(*window), options));
}

LcmLogReader::LcmLogReader(std::span<const std::uint8_t> log, const LcmLogReaderOptions& options)
    : LcmLogReader(std::make_unique<LcmLogWindow>(log), options) {
    HV_EXPECT(options.max_data_bytes > 0);
}

Result<LcmLogEvent> LcmLogReader::Next() {
    const std::optional<Place> place = Find(position_);
    if (window_->failed()) return Error::kFailed;
    CountSkipped(place);
    position_ = size_bytes();
    if (!place) return Error::kEndOfStream;

    const LcmLogHeader& header = place->header;
    const auto bytes = window_->Lend(place->at, static_cast<std::size_t>(header.EventBytes()));
    if (bytes.empty()) return Error::kFailed;
    position_ = place->at + bytes.size();
    last_number_ = header.number;
    const auto channel_bytes = static_cast<std::size_t>(header.channel_bytes);
    const auto channel = bytes.subspan(kLcmLogHeaderBytes, channel_bytes);
    return LcmLogEvent{.number = header.number,
                       .utime_us = header.utime_us,
                       .channel = {reinterpret_cast<const char*>(channel.data()), channel_bytes},
                       .data = bytes.subspan(kLcmLogHeaderBytes + channel_bytes),
                       .position_bytes = place->at};
}

Result<Done> LcmLogReader::SeekToTime(std::int64_t utime_us) {
    last_number_.reset();
    std::optional<Place> place = Find(StartBefore(utime_us - kMostDisorder_us));
    while (place && place->header.utime_us < utime_us)
        place = Find(place->at + place->header.EventBytes());
    position_ = place ? place->at : size_bytes();
    if (window_->failed()) return Error::kFailed;
    if (!place) return Error::kEndOfStream;
    return Done{};
}

/// The start of an event before which all are earlier than `utime_us`, or of the file.
std::uint64_t LcmLogReader::StartBefore(std::int64_t utime_us) {
    std::uint64_t early = 0;
    std::uint64_t late = size_bytes();
    while (late - early > LcmLogWindow::kBytes) {
        const std::uint64_t middle = early + (late - early) / 2;
        const std::optional<Place> place = Find(middle);
        if (place && place->at < late && place->header.utime_us < utime_us) {
            early = place->at;
        } else {
            late = middle;
        }
    }
    return early;
}

std::optional<LcmLogReader::Place> LcmLogReader::Find(std::uint64_t from) {
    std::optional<std::uint64_t> at = from;
    while (at) {
        const auto header = HeaderAt(*at);
        if (header && IsEvent({*at, *header})) return Place{*at, *header};
        at = window_->Find(kLcmLogSync, *at + 1, size_bytes());
    }
    return std::nullopt;
}

std::optional<LcmLogHeader> LcmLogReader::HeaderAt(std::uint64_t at) {
    LcmLogHeaderBytes bytes{};
    if (!window_->Copy(at, bytes)) return std::nullopt;
    if (!std::ranges::equal(kLcmLogSync, std::span(bytes).first(kLcmLogSync.size())))
        return std::nullopt;
    const LcmLogHeader header = DecodeLcmLogHeader(bytes);
    const bool sound = header.HasSoundLengths() && header.data_bytes <= options_.max_data_bytes &&
                       header.EventBytes() <= size_bytes() - at &&
                       HasChannel(at + kLcmLogHeaderBytes, header.channel_bytes);
    return sound ? std::optional(header) : std::nullopt;
}

bool LcmLogReader::HasChannel(std::uint64_t at, std::int32_t channel_bytes) {
    std::array<std::uint8_t, kLcmLongestChannel> memory{};
    const auto channel = std::span(memory).first(static_cast<std::size_t>(channel_bytes));
    return window_->Copy(at, channel) && std::ranges::all_of(channel, IsPrintable);
}

bool LcmLogReader::IsEvent(const Place& place) {
    const std::uint64_t end = place.at + place.header.EventBytes();
    const Evidence evidence = EvidenceOfEnd(place.header, end);
    if (evidence == Evidence::kFull) return true;
    if (evidence == Evidence::kNone && !IsLossAt(end, place.header.number)) return false;
    // A damaged length may happen to end at a later event: it then swallows those that follow.
    return !HoldsLaterEvent(place, end);
}

LcmLogReader::Evidence LcmLogReader::EvidenceOfEnd(const LcmLogHeader& header, std::uint64_t end) {
    LcmLogHeaderBytes bytes{};
    const auto rest =
        static_cast<std::size_t>(std::min<std::uint64_t>(kLcmLogHeaderBytes, size_bytes() - end));
    if (!window_->Copy(end, std::span(bytes).first(rest))) return Evidence::kNone;

    const std::size_t sync_bytes = std::min(rest, kLcmLogSync.size());
    const bool sync = std::equal(bytes.begin(), bytes.begin() + sync_bytes, kLcmLogSync.begin());
    const LcmLogHeader next = DecodeLcmLogHeader(bytes);
    const bool counts_up =
        rest == kLcmLogHeaderBytes && NumbersFrom(header.number, next.number) == 1;
    if (sync && counts_up) return Evidence::kFull;
    const bool sound = rest == kLcmLogHeaderBytes && next.HasSoundLengths() &&
                       AreNear(next.utime_us, header.utime_us);
    return sync || counts_up || sound ? Evidence::kSome : Evidence::kNone;
}

std::optional<LcmLogReader::Place> LcmLogReader::FindHeader(std::uint64_t from,
                                                            std::uint64_t until) {
    auto at = window_->Find(kLcmLogSync, from, until);
    while (at) {
        if (const auto header = HeaderAt(*at)) return Place{*at, *header};
        at = window_->Find(kLcmLogSync, *at + 1, until);
    }
    return std::nullopt;
}

bool LcmLogReader::IsLossAt(std::uint64_t end, std::int64_t number) {
    const auto next = FindHeader(end, size_bytes());
    if (!next) return IsZeroFrom(end);
    const std::uint64_t missing = NumbersFrom(number, next->header.number) - 1;
    return missing >= 1 && missing <= MostEventsIn(next->at - end);
}

bool LcmLogReader::IsZeroFrom(std::uint64_t end) {
    std::array<std::uint8_t, 4096> memory{};
    const auto rest = std::min<std::uint64_t>(memory.size(), size_bytes() - end);
    const auto bytes = std::span(memory).first(static_cast<std::size_t>(rest));
    // If its last byte is zero too, the zeros may have begun inside the event.
    std::array<std::uint8_t, 1> last{};
    return window_->Copy(end - 1, last) && last[0] != 0 && window_->Copy(end, bytes) &&
           std::ranges::all_of(bytes, [](auto b) { return b == 0; });
}

bool LcmLogReader::HoldsLaterEvent(const Place& place, std::uint64_t end) {
    std::uint64_t from = place.at + kLcmLogHeaderBytes;
    while (const auto inner = FindHeader(from, end)) {
        const std::uint64_t later = NumbersFrom(place.header.number, inner->header.number);
        if (later >= 1 && later <= MostEventsIn(inner->at - place.at)) return true;
        from = inner->at + 1;
    }
    return false;
}

void LcmLogReader::CountSkipped(const std::optional<Place>& next) {
    const std::uint64_t end = next ? next->at : size_bytes();
    const std::uint64_t skipped = end - position_;
    if (skipped == 0) return;
    ++damage_.places;
    damage_.skipped_bytes += skipped;
    if (!next) damage_.torn_bytes = skipped;
    // Damaged numbers may claim any loss.
    const std::uint64_t missing =
        next && last_number_ ? NumbersFrom(*last_number_, next->header.number) - 1 : 1;
    damage_.lost_events += missing <= MostEventsIn(skipped) ? missing : 1;
}

}  // namespace hitchview::drivers
