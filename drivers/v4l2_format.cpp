#include "drivers/v4l2_format.hpp"

#include <linux/videodev2.h>

#include <algorithm>

namespace hitchview::drivers {
namespace {

constexpr std::array kFormats{
    V4l2PixelFormat{V4L2_PIX_FMT_NV12, "nv12", hal::PixelFormat::kNv12, 1, 1},
    V4l2PixelFormat{V4L2_PIX_FMT_NV12M, "nm12", hal::PixelFormat::kNv12, 2, 1},
    V4l2PixelFormat{V4L2_PIX_FMT_UYVY, "uyvy", hal::PixelFormat::kUyvy, 1, 2},
    V4l2PixelFormat{V4L2_PIX_FMT_YUYV, "yuyv", hal::PixelFormat::kYuyv, 1, 2},
    V4l2PixelFormat{V4L2_PIX_FMT_MJPEG, "mjpeg", hal::PixelFormat::kNv12, 1, 0},
    V4l2PixelFormat{V4L2_PIX_FMT_JPEG, "jpeg", hal::PixelFormat::kNv12, 1, 0},
    V4l2PixelFormat{V4L2_PIX_FMT_GREY, "grey", hal::PixelFormat::kGrey, 1, 1},
};

/// The last line may lack its padding.
std::size_t LinesBytes(int line_bytes, int lines, int last_line_bytes) {
    return static_cast<std::size_t>(line_bytes) * static_cast<std::size_t>(lines - 1) +
           static_cast<std::size_t>(last_line_bytes);
}

using MaybePlanes = std::optional<std::array<hal::Plane, 3>>;

MaybePlanes OneMemoryPlane(const V4l2Layout& layout, std::span<const std::uint8_t> bytes,
                           const V4l2PixelFormat& format) {
    const int line_bytes = layout.planes[0].line_bytes;
    const bool chroma_follows = format.delivered == hal::PixelFormat::kNv12;
    const int lines = chroma_follows ? layout.height_px * 3 / 2 : layout.height_px;
    const int used_bytes = layout.width_px * format.line_bytes_per_pixel;
    if (bytes.size() < LinesBytes(line_bytes, lines, used_bytes)) return std::nullopt;
    const hal::Plane first{bytes.data(), line_bytes};
    if (!chroma_follows) return std::array{first, hal::Plane{}, hal::Plane{}};
    const std::ptrdiff_t luma_bytes = static_cast<std::ptrdiff_t>(line_bytes) * layout.height_px;
    return std::array{first, hal::Plane{bytes.data() + luma_bytes, line_bytes}, hal::Plane{}};
}

MaybePlanes TwoMemoryPlanes(const V4l2Layout& layout, const V4l2Payload& payload) {
    std::array<hal::Plane, 3> planes{};
    for (std::size_t i = 0; i < 2; ++i) {
        const int line_bytes = layout.planes[i].line_bytes;
        const int lines = i == 0 ? layout.height_px : layout.height_px / 2;
        if (payload[i].size() < LinesBytes(line_bytes, lines, layout.width_px)) return std::nullopt;
        planes[i] = {payload[i].data(), line_bytes};
    }
    return planes;
}

}  // namespace

std::span<const V4l2PixelFormat> V4l2PixelFormats() {
    return kFormats;
}

const V4l2PixelFormat* FindV4l2PixelFormat(std::uint32_t fourcc) {
    const auto* found = std::ranges::find(kFormats, fourcc, &V4l2PixelFormat::fourcc);
    return found == kFormats.end() ? nullptr : found;
}

const V4l2PixelFormat* FindV4l2PixelFormat(const std::string& name) {
    const auto* found = std::ranges::find(kFormats, name, &V4l2PixelFormat::name);
    return found == kFormats.end() ? nullptr : found;
}

std::string FourccText(std::uint32_t fourcc) {
    std::string text;
    for (unsigned shift = 0; shift < 32; shift += 8) {
        const char letter = static_cast<char>((fourcc >> shift) & 0x7FU);
        text += letter >= ' ' && letter <= '~' ? letter : '?';
    }
    return text;
}

hal::Range RangeOf(std::uint32_t fourcc, std::uint32_t quantization, std::uint32_t colorspace) {
    if (quantization == V4L2_QUANTIZATION_FULL_RANGE) return hal::Range::kFull;
    if (quantization == V4L2_QUANTIZATION_LIM_RANGE) return hal::Range::kLimited;
    const bool full = fourcc == V4L2_PIX_FMT_GREY || colorspace == V4L2_COLORSPACE_JPEG;
    return full ? hal::Range::kFull : hal::Range::kLimited;
}

bool HoldsLines(const V4l2Layout& layout) {
    const V4l2PixelFormat* format = FindV4l2PixelFormat(layout.fourcc);
    if (format == nullptr) return false;
    const auto used =
        std::span(layout.planes).first(static_cast<std::size_t>(format->memory_planes));
    return std::ranges::all_of(used, [&](const V4l2Layout::MemoryPlane& plane) {
        return plane.line_bytes >= std::int64_t{layout.width_px} * format->line_bytes_per_pixel;
    });
}

std::optional<std::array<hal::Plane, 3>> PlanesOf(const V4l2Layout& layout,
                                                  const V4l2Payload& payload) {
    const V4l2PixelFormat* format = FindV4l2PixelFormat(layout.fourcc);
    if (format == nullptr || format->line_bytes_per_pixel == 0) return std::nullopt;
    return format->memory_planes == 2 ? TwoMemoryPlanes(layout, payload)
                                      : OneMemoryPlane(layout, payload[0], *format);
}

}  // namespace hitchview::drivers
