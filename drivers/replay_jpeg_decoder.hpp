#pragma once

#include <array>
#include <cstdint>
#include <memory>
#include <string>
#include <vector>

#include "drivers/frame_colour.hpp"

namespace hitchview::drivers {

/// JPEG files straight to their YCbCr planes, without a detour over RGB.
class JpegDecoder {
 public:
    enum class Outcome {
        kDecoded,
        kNotForUs,  ///< no JPEG, or one of a rare kind: other colours, other sampling
        kDamaged,   ///< unreadable, cut short or with broken data
    };

    JpegDecoder();

    Outcome Decode(const std::string& path);

    /// Of the last picture decoded; valid until the next Decode.
    [[nodiscard]] int width_px() const { return width_px_; }
    [[nodiscard]] int height_px() const { return height_px_; }
    [[nodiscard]] const YuvPicture& picture() const { return picture_; }

 private:
    struct Destroy {
        void operator()(void* handle) const;
    };

    bool ReadFile(const std::string& path);
    bool DecodePlanes(int subsampling);

    std::unique_ptr<void, Destroy> handle_;
    std::vector<std::uint8_t> file_;
    std::array<std::vector<std::uint8_t>, 3> planes_;
    YuvPicture picture_{};
    int width_px_ = 0;
    int height_px_ = 0;
};

}  // namespace hitchview::drivers
