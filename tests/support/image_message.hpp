#pragma once

#include <cstdint>
#include <string>
#include <utility>
#include <vector>

namespace hitchview::tests {

/// A bot_core.image_t as a sender may make it, sound or not. Encoded here by hand, so that it can
/// also hold what no honest encoder writes.
struct ImageMessage {
    /// Places of the fields whose value a damaged message may get wrong.
    static constexpr std::size_t kWidthAt = 16;
    static constexpr std::size_t kHeightAt = 20;
    static constexpr std::size_t kRowStrideAt = 24;
    static constexpr std::size_t kPixelFormatAt = 28;
    static constexpr std::size_t kSizeAt = 32;
    static constexpr std::size_t kDataAt = 36;

    std::uint64_t fingerprint = 0x14739ffe13d5f5f0;
    std::int32_t width_px = 64;
    std::int32_t height_px = 32;
    std::int32_t pixel_format = 1196444237;  // MJPG
    std::vector<std::uint8_t> data{0xFF, 0xD8, 0xFF, 0xD9};
    std::vector<std::pair<std::string, std::string>> properties{{"sequence", "7"},
                                                                {"captured_from_ns", "1000"},
                                                                {"captured_until_ns", "2000"},
                                                                {"cameras_missing", "0x00000005"},
                                                                {"calibration_id", "abc"}};

    [[nodiscard]] std::vector<std::uint8_t> Encode() const;
    [[nodiscard]] std::size_t PropertyCountAt() const { return kDataAt + data.size(); }
};

/// Overwrites four bytes with a big-endian number.
void PutInt32(std::vector<std::uint8_t>& bytes, std::size_t at, std::int32_t value);

}  // namespace hitchview::tests
