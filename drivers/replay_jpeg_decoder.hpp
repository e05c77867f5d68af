#pragma once

#include <array>
#include <cstdint>
#include <memory>
#include <span>
#include <string>
#include <vector>

#include "drivers/frame_colour.hpp"

namespace hitchview::drivers {

/// JPEG files of one size straight to their YCbCr planes, without a detour over RGB.
class JpegDecoder {
 public:
    enum class Outcome {
        kDecoded,
        kNotForUs,  ///< no JPEG, or one of a rare kind: other colours, other sampling
        kDamaged,   ///< unreadable, cut short, with broken data or of another size
    };

    JpegDecoder(int width_px, int height_px);

    /// At most 256 MiB.
    Outcome DecodeFile(const std::string& path);
    /// The same of a file's content.
    Outcome Decode(std::span<const std::uint8_t> jpeg);

    /// The last one decoded; valid until the next Decode.
    [[nodiscard]] const YuvPicture& picture() const { return picture_; }

 private:
    struct Destroy {
        void operator()(void* handle) const;
    };

    bool ReadFile(const std::string& path);
    bool DecodePlanes(std::span<const std::uint8_t> jpeg, int subsampling);

    int width_px_;
    int height_px_;
    std::unique_ptr<void, Destroy> handle_;
    std::vector<std::uint8_t> file_;
    std::array<std::vector<std::uint8_t>, 3> planes_;
    YuvPicture picture_{};
};

}  // namespace hitchview::drivers
