#pragma once

#include <array>
#include <charconv>
#include <cstdint>
#include <span>
#include <string_view>

#include "hal/publisher.hpp"
#include "lcmtypes/bot_core_image_t.h"

namespace hitchview::drivers {

/// The properties of an image as printable text, in memory of its own. For LcmEncoder alone.
class LcmImageProperties {
 public:
    explicit LcmImageProperties(const hal::PanoramaImage& image) {
        AddNumber("sequence", image.sequence);
        AddNumber("captured_from_ns", image.captured_from.count());
        AddNumber("captured_until_ns", image.captured_until.count());
        AddMask("cameras_missing", image.cameras_missing);
        Add("calibration_id", image.calibration_id);
    }

    explicit LcmImageProperties(const hal::PreviewImage& preview) {
        AddNumber("sequence", preview.sequence);
        AddNumber("captured_ns", preview.captured_at.count());
    }

    LcmImageProperties(const LcmImageProperties&) = delete;
    LcmImageProperties& operator=(const LcmImageProperties&) = delete;

    [[nodiscard]] std::span<bot_core_image_metadata_t> entries() {
        return std::span(entries_).first(count_);
    }

 private:
    using Text = std::array<char, 24>;

    void AddNumber(const char* key, std::int64_t value) {
        Text& text = texts_.at(count_);
        const auto end = std::to_chars(text.data(), text.data() + text.size(), value).ptr;
        Add(key, {text.data(), static_cast<std::size_t>(end - text.data())});
    }

    void AddMask(const char* key, std::uint32_t mask) {
        constexpr std::string_view kDigits = "0123456789abcdef";
        Text& text = texts_.at(count_);
        text = {'0', 'x'};
        for (int i = 0; i < 8; ++i) text.at(2 + i) = kDigits[mask >> (28 - 4 * i) & 0xF];
        Add(key, {text.data(), 10});
    }

    // The generated type has no const members; encoding only reads them.
    void Add(const char* key, std::string_view value) {
        const auto* bytes = reinterpret_cast<const std::uint8_t*>(value.data());
        entries_.at(count_++) = {.key = const_cast<char*>(key),
                                 .n = static_cast<std::int32_t>(value.size()),
                                 .value = const_cast<std::uint8_t*>(bytes)};
    }

    std::array<bot_core_image_metadata_t, 5> entries_{};
    std::array<Text, 5> texts_{};
    std::size_t count_ = 0;
};

}  // namespace hitchview::drivers
