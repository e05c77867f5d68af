#include "drivers/lcm_image_message.hpp"

#include <array>
#include <charconv>
#include <optional>
#include <string_view>

#include "drivers/lcm_message_reader.hpp"
#include "lcmtypes/bot_core_image_t.h"

namespace hitchview::drivers {
namespace {

using hal::Error;
using hal::PanoramaImage;
using hal::Result;

constexpr int kLongestSide_px = 16384;
constexpr int kMostProperties = 64;

template <typename Int>
bool ParseNumber(std::string_view text, Int& value, int base = 10) {
    const char* const last = text.data() + text.size();
    const auto [end, error] = std::from_chars(text.data(), last, value, base);
    return !text.empty() && error == std::errc{} && end == last;
}

bool ParseInstant(std::string_view text, hal::Instant& instant) {
    std::int64_t ns = 0;
    if (!ParseNumber(text, ns)) return false;
    instant = hal::Instant(ns);
    return true;
}

struct Property {
    std::string_view key;
    bool (*parse)(std::string_view value, PanoramaImage& image);
};

constexpr std::array<Property, 5> kProperties{{
    {"sequence", [](auto value, auto& image) { return ParseNumber(value, image.sequence); }},
    {"captured_from_ns",
     [](auto value, auto& image) { return ParseInstant(value, image.captured_from); }},
    {"captured_until_ns",
     [](auto value, auto& image) { return ParseInstant(value, image.captured_until); }},
    {"cameras_missing",
     [](auto value, auto& image) {
         return value.starts_with("0x") && ParseNumber(value.substr(2), image.cameras_missing, 16);
     }},
    {"calibration_id",
     [](auto value, auto& image) {
         image.calibration_id = value;
         return true;
     }},
}};

/// Which properties were seen, bit i for kProperties[i]; 0 when one is damaged.
unsigned TakeProperties(LcmMessageReader& reader, PanoramaImage& image) {
    unsigned seen = 0;
    const auto count = reader.Take<std::int32_t>();
    if (count < 0 || count > kMostProperties) return 0;
    for (int n = 0; n < count && reader.ok(); ++n) {
        const std::string_view key = reader.TakeString();
        const std::string_view value = reader.TakeText(reader.Take<std::int32_t>());
        for (std::size_t i = 0; i < kProperties.size(); ++i) {
            if (key != kProperties.at(i).key) continue;
            if ((seen >> i & 1U) != 0 || !kProperties.at(i).parse(value, image)) return 0;
            seen |= 1U << i;
        }
    }
    return seen;
}

bool IsSide(int side_px) {
    return side_px >= 1 && side_px <= kLongestSide_px;
}

}  // namespace

Result<PanoramaImage> ParseImageMessage(std::span<const std::uint8_t> message) {
    constexpr unsigned kAllProperties = (1U << kProperties.size()) - 1;
    LcmMessageReader reader(message);
    if (reader.Take<std::int64_t>() != __bot_core_image_t_get_hash()) return Error::kCorrupted;

    PanoramaImage image;
    reader.Take<std::int64_t>();  // utime: the capture times are told more exactly below
    image.width_px = reader.Take<std::int32_t>();
    image.height_px = reader.Take<std::int32_t>();
    const auto row_stride_bytes = reader.Take<std::int32_t>();
    const auto pixel_format = reader.Take<std::int32_t>();
    image.jpeg = reader.TakeBytes(reader.Take<std::int32_t>());
    const unsigned seen = TakeProperties(reader, image);

    const bool sound = reader.at_end() && seen == kAllProperties && IsSide(image.width_px) &&
                       IsSide(image.height_px) && row_stride_bytes >= 0 && !image.jpeg.empty() &&
                       pixel_format == BOT_CORE_IMAGE_T_PIXEL_FORMAT_MJPEG;
    if (!sound) return Error::kCorrupted;
    return image;
}

}  // namespace hitchview::drivers
