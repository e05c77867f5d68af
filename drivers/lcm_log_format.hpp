#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <span>
#include <string_view>

#include "drivers/lcm_message_reader.hpp"

namespace hitchview::drivers {

/// Every event of an LCM log begins with it. Source for the layout: LCM's documentation, "LCM Log
/// File format".
inline constexpr std::array<std::uint8_t, 4> kLcmLogSync{0xED, 0xA1, 0xDA, 0x01};
inline constexpr std::size_t kLcmLogHeaderBytes = 28;
inline constexpr std::int32_t kLcmLongestChannel = 63;  ///< characters of a channel's name

/// What stands between the sync word and the name of the channel; big-endian in the file.
struct LcmLogHeader {
    std::int64_t number = 0;  ///< counts up by one in a file
    std::int64_t utime_us = 0;
    std::int32_t channel_bytes = 0;
    std::int32_t data_bytes = 0;

    /// Lengths that an event may have.
    [[nodiscard]] bool HasSoundLengths() const {
        return channel_bytes >= 1 && channel_bytes <= kLcmLongestChannel && data_bytes >= 0;
    }
    /// Of the whole event. Sound lengths only.
    [[nodiscard]] std::uint64_t EventBytes() const {
        return kLcmLogHeaderBytes + static_cast<std::uint64_t>(channel_bytes) +
               static_cast<std::uint64_t>(data_bytes);
    }
};

using LcmLogHeaderBytes = std::array<std::uint8_t, kLcmLogHeaderBytes>;

/// Whatever stands behind the first four bytes.
inline LcmLogHeader DecodeLcmLogHeader(const LcmLogHeaderBytes& bytes) {
    const std::span<const std::uint8_t> all(bytes);
    LcmMessageReader reader(all.subspan(kLcmLogSync.size()));
    LcmLogHeader header;
    header.number = reader.Take<std::int64_t>();
    header.utime_us = reader.Take<std::int64_t>();
    header.channel_bytes = reader.Take<std::int32_t>();
    header.data_bytes = reader.Take<std::int32_t>();
    return header;
}

inline LcmLogHeaderBytes EncodeLcmLogHeader(const LcmLogHeader& header) {
    LcmLogHeaderBytes bytes{};
    std::size_t at = 0;
    const auto put = [&](std::uint64_t value, int count) {
        for (int shift = 8 * (count - 1); shift >= 0; shift -= 8)
            bytes.at(at++) = static_cast<std::uint8_t>(value >> shift);
    };
    for (const std::uint8_t byte : kLcmLogSync) put(byte, 1);
    put(static_cast<std::uint64_t>(header.number), 8);
    put(static_cast<std::uint64_t>(header.utime_us), 8);
    put(static_cast<std::uint64_t>(header.channel_bytes), 4);
    put(static_cast<std::uint64_t>(header.data_bytes), 4);
    return bytes;
}

/// One message of a log, borrowed from who read it.
struct LcmLogEvent {
    std::int64_t number = 0;
    std::int64_t utime_us = 0;  ///< since the epoch
    std::string_view channel{};
    std::span<const std::uint8_t> data{};
    std::uint64_t position_bytes = 0;  ///< of its first byte in the file
};

}  // namespace hitchview::drivers
