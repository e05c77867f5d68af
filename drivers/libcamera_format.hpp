#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <optional>
#include <span>
#include <string>

#include "hal/frame.hpp"

namespace hitchview::drivers {

/// One format of pixels that the driver takes, in libcamera's words (DRM) and in ours.
struct LibcameraPixelFormat {
    enum class Packed : std::uint8_t {
        kLent,          ///< as it comes
        kBlueGreenRed,  ///< three bytes in this order, converted to NV12
        kRedGreenBlue,
    };

    std::uint32_t fourcc;
    const char* name;            ///< as in a configuration: nv12
    hal::PixelFormat delivered;  ///< of the frames that are lent
    Packed packed;
    int line_bytes_per_pixel;  ///< of the first plane
};

/// Every format that is taken, the best first: as V4L2's, and behind what is lent the two that cost
/// a conversion. DRM names colours from the most significant bit down: RGB888 lies in memory as
/// blue, green, red.
std::span<const LibcameraPixelFormat> LibcameraPixelFormats();

/// How one frame lies in memory.
struct LibcameraLayout {
    const LibcameraPixelFormat* pixel_format = nullptr;
    int width_px = 0;
    int height_px = 0;
    int stride_bytes = 0;  ///< of every plane

    friend bool operator==(const LibcameraLayout&, const LibcameraLayout&) = default;
};

/// No line of a picture runs into the next one.
bool HoldsLines(const LibcameraLayout& layout);

/// Bytes that a whole frame has at least: the last line of a plane may lack its padding.
std::size_t LeastBytes(const LibcameraLayout& layout);

using LibcameraPlanes = std::array<std::span<const std::uint8_t>, 3>;

/// Planes of one frame, of a layout that HoldsLines. `memory`: one span for all, or one for each
/// plane. Empty if one is shorter than its picture.
std::optional<std::array<hal::Plane, 3>> PlanesOf(const LibcameraLayout& layout,
                                                  const LibcameraPlanes& memory);

/// Fills a tightly packed frame of the format that is delivered: copied, or converted to full-range
/// NV12. `planes`: as PlanesOf gives them.
void FillPacked(const LibcameraLayout& layout, const std::array<hal::Plane, 3>& planes,
                std::span<std::uint8_t> frame);

}  // namespace hitchview::drivers
