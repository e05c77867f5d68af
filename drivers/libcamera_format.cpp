#include "drivers/libcamera_format.hpp"

#include <algorithm>

#include "drivers/frame_colour.hpp"

namespace hitchview::drivers {
namespace {

using Packed = LibcameraPixelFormat::Packed;

constexpr std::uint32_t Fourcc(char a, char b, char c, char d) {
    const auto byte = [](char letter) { return static_cast<std::uint32_t>(letter); };
    return byte(a) | byte(b) << 8 | byte(c) << 16 | byte(d) << 24;
}

constexpr std::array kFormats{
    LibcameraPixelFormat{Fourcc('N', 'V', '1', '2'), "nv12", hal::PixelFormat::kNv12, Packed::kLent,
                         1},
    LibcameraPixelFormat{Fourcc('U', 'Y', 'V', 'Y'), "uyvy", hal::PixelFormat::kUyvy, Packed::kLent,
                         2},
    LibcameraPixelFormat{Fourcc('Y', 'U', 'Y', 'V'), "yuyv", hal::PixelFormat::kYuyv, Packed::kLent,
                         2},
    LibcameraPixelFormat{Fourcc('B', 'G', '2', '4'), "bgr888", hal::PixelFormat::kNv12,
                         Packed::kRedGreenBlue, 3},
    LibcameraPixelFormat{Fourcc('R', 'G', '2', '4'), "rgb888", hal::PixelFormat::kNv12,
                         Packed::kBlueGreenRed, 3},
    LibcameraPixelFormat{Fourcc('R', '8', ' ', ' '), "grey", hal::PixelFormat::kGrey, Packed::kLent,
                         1},
};

struct PlaneShape {
    std::size_t line_bytes = 0;
    std::size_t lines = 0;
};

/// Luma or packed pixels, and chroma where it is a plane of its own.
std::array<PlaneShape, 2> ShapesOf(const LibcameraLayout& layout) {
    const LibcameraPixelFormat& format = *layout.pixel_format;
    const auto height = static_cast<std::size_t>(layout.height_px);
    const auto line_bytes = static_cast<std::size_t>(layout.width_px * format.line_bytes_per_pixel);
    const bool two = format.packed == Packed::kLent && format.delivered == hal::PixelFormat::kNv12;
    return {PlaneShape{line_bytes, height},
            two ? PlaneShape{line_bytes, height / 2} : PlaneShape{}};
}

std::size_t LeastBytes(const PlaneShape& shape, std::size_t stride_bytes) {
    return shape.lines == 0 ? 0 : (shape.lines - 1) * stride_bytes + shape.line_bytes;
}

}  // namespace

std::span<const LibcameraPixelFormat> LibcameraPixelFormats() {
    return kFormats;
}

bool HoldsLines(const LibcameraLayout& layout) {
    return layout.stride_bytes >=
           std::int64_t{layout.width_px} * layout.pixel_format->line_bytes_per_pixel;
}

std::size_t LeastBytes(const LibcameraLayout& layout) {
    const auto stride = static_cast<std::size_t>(layout.stride_bytes);
    std::size_t bytes = 0;
    for (const PlaneShape& shape : ShapesOf(layout)) bytes += LeastBytes(shape, stride);
    return bytes;
}

std::optional<std::array<hal::Plane, 3>> PlanesOf(const LibcameraLayout& layout,
                                                  const LibcameraPlanes& memory) {
    const auto stride = static_cast<std::size_t>(layout.stride_bytes);
    const auto shapes = ShapesOf(layout);
    std::array<hal::Plane, 3> planes{};
    std::span<const std::uint8_t> rest;
    for (std::size_t i = 0; i < shapes.size() && shapes[i].lines > 0; ++i) {
        if (!memory[i].empty()) rest = memory[i];
        if (rest.size() < LeastBytes(shapes[i], stride)) return std::nullopt;
        planes[i] = {rest.data(), layout.stride_bytes};
        rest = rest.subspan(std::min(rest.size(), stride * shapes[i].lines));
    }
    return planes;
}

void FillPacked(const LibcameraLayout& layout, const std::array<hal::Plane, 3>& planes,
                std::span<std::uint8_t> frame) {
    const LibcameraPixelFormat& format = *layout.pixel_format;
    if (format.packed != Packed::kLent) {
        const ChannelOrder order = format.packed == Packed::kBlueGreenRed
                                       ? ChannelOrder::kBlueGreenRed
                                       : ChannelOrder::kRedGreenBlue;
        ToNv12(BgrPicture{planes[0].data, layout.stride_bytes, order},
               {layout.width_px, layout.height_px, hal::PixelFormat::kNv12}, frame);
        return;
    }
    std::uint8_t* out = frame.data();
    const auto shapes = ShapesOf(layout);
    for (std::size_t i = 0; i < shapes.size(); ++i) {
        const std::uint8_t* line = planes[i].data;
        for (std::size_t y = 0; y < shapes[i].lines; ++y, line += layout.stride_bytes)
            out = std::copy_n(line, shapes[i].line_bytes, out);
    }
}

}  // namespace hitchview::drivers
