#pragma once

#include <array>
#include <chrono>
#include <cstddef>
#include <cstdint>

namespace hitchview::hal {

/// A moment of CLOCK_MONOTONIC, nanoseconds since boot.
using Instant = std::chrono::nanoseconds;

enum class PixelFormat : std::uint8_t {
    kNv12,  ///< plane 0: Y, plane 1: interleaved U V at half width and height
    kI420,  ///< plane 0: Y, plane 1: U, plane 2: V, the latter two at half width and height
    kUyvy,  ///< plane 0: U Y V Y, two pixels in four bytes
    kYuyv,  ///< plane 0: Y U Y V
    kGrey,  ///< plane 0: Y
};

/// How the luma and chroma bytes are to be read.
enum class Range : std::uint8_t {
    kFull,     ///< Y 0..255, as in JPEG
    kLimited,  ///< Y 16..235, as in television
};

/// Size and layout of the frames of one camera; fixed while the camera is open. Even width and
/// height.
struct FrameFormat {
    int width_px = 0;
    int height_px = 0;
    PixelFormat pixel_format = PixelFormat::kNv12;
    Range range = Range::kFull;

    friend bool operator==(const FrameFormat&, const FrameFormat&) = default;
};

struct FrameHeader {
    std::uint32_t sequence = 0;  ///< steps by one; a gap is frames the camera lost
    Instant captured_at{};       ///< start of exposure
};

struct Plane {
    const std::uint8_t* data = nullptr;
    int stride_bytes = 0;
};

/// Borrowed pixels of one frame. Valid as long as the lease it came from.
struct FrameView {
    FrameFormat format;
    FrameHeader header;
    std::array<Plane, 3> planes;
};

/// Bytes of one tightly packed frame.
constexpr std::size_t FrameBytes(const FrameFormat& format) {
    const auto pixels =
        static_cast<std::size_t>(format.width_px) * static_cast<std::size_t>(format.height_px);
    switch (format.pixel_format) {
        case PixelFormat::kNv12:
        case PixelFormat::kI420:
            return pixels * 3 / 2;
        case PixelFormat::kUyvy:
        case PixelFormat::kYuyv:
            return pixels * 2;
        case PixelFormat::kGrey:
            return pixels;
    }
    return 0;
}

/// Planes of a tightly packed frame that starts at `data`.
constexpr std::array<Plane, 3> PackedPlanes(const FrameFormat& format, const std::uint8_t* data) {
    const int width = format.width_px;
    const std::ptrdiff_t luma = static_cast<std::ptrdiff_t>(width) * format.height_px;
    switch (format.pixel_format) {
        case PixelFormat::kNv12:
            return {Plane{data, width}, Plane{data + luma, width}, Plane{}};
        case PixelFormat::kI420:
            return {Plane{data, width}, Plane{data + luma, width / 2},
                    Plane{data + luma + luma / 4, width / 2}};
        case PixelFormat::kUyvy:
        case PixelFormat::kYuyv:
            return {Plane{data, 2 * width}, Plane{}, Plane{}};
        case PixelFormat::kGrey:
            return {Plane{data, width}, Plane{}, Plane{}};
    }
    return {};
}

}  // namespace hitchview::hal
