#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <optional>
#include <span>
#include <string>

#include "hal/frame.hpp"

namespace hitchview::drivers {

/// One format of pixels that this driver takes, in the kernel's words and in ours.
struct V4l2PixelFormat {
    std::uint32_t fourcc;
    const char* name;            ///< as in a configuration: uyvy
    hal::PixelFormat delivered;  ///< of the frames that are lent
    int memory_planes;           ///< 2: luma and chroma are separate memory
    int line_bytes_per_pixel;    ///< of the first plane; 0: compressed
};

/// Every format that is taken, the best first:
///  1. nv12, nm12: 1.5 bytes a pixel, the least memory to read, and the chroma that the panorama
///     keeps anyway; one memory plane before two, as it takes one DMABUF;
///  2. uyvy, yuyv: 2 bytes a pixel, untouched; uyvy first, as CSI-2 links carry it natively;
///  3. mjpeg: lossy, and each frame is decoded; where a USB link carries nothing else at the rate;
///  4. grey: no colours.
std::span<const V4l2PixelFormat> V4l2PixelFormats();

/// Null if not one of ours.
const V4l2PixelFormat* FindV4l2PixelFormat(std::uint32_t fourcc);
const V4l2PixelFormat* FindV4l2PixelFormat(const std::string& name);

/// "UYVY"; what cannot be printed, as '?'.
std::string FourccText(std::uint32_t fourcc);

/// How the kernel's default rule reads colours unless the driver says (v4l2_quantization): limited
/// range, but full for JPEG's colours (v4l2_colorspace) and for grey, which is a sensor's own.
hal::Range RangeOf(std::uint32_t fourcc, std::uint32_t quantization, std::uint32_t colorspace);

/// How one frame lies in memory, as the driver decided it.
struct V4l2Layout {
    struct MemoryPlane {
        int line_bytes = 0;  ///< from line to line, padding included
        std::uint32_t size_bytes = 0;

        friend bool operator==(const MemoryPlane&, const MemoryPlane&) = default;
    };

    std::uint32_t fourcc = 0;
    int width_px = 0;
    int height_px = 0;
    int memory_planes = 1;
    std::array<MemoryPlane, 3> planes{};
    hal::Range range = hal::Range::kLimited;
    bool interlaced = false;

    friend bool operator==(const V4l2Layout&, const V4l2Layout&) = default;
};

/// No line of a picture that is not compressed runs into the next one.
bool HoldsLines(const V4l2Layout& layout);

/// Where a frame's bytes are: per memory plane, without what precedes the picture in it.
using V4l2Payload = std::array<std::span<const std::uint8_t>, 3>;

/// Planes for the renderer, of a layout that HoldsLines. Empty if a memory plane is shorter than
/// its picture: a damaged frame. Not for compressed formats.
std::optional<std::array<hal::Plane, 3>> PlanesOf(const V4l2Layout& layout,
                                                  const V4l2Payload& payload);

}  // namespace hitchview::drivers
