#pragma once

#include <array>
#include <cstdint>
#include <span>

#include "hal/frame.hpp"

namespace hitchview::drivers {

enum class ChannelOrder : std::uint8_t { kBlueGreenRed, kRedGreenBlue };

/// Three bytes a pixel; at least as large as the frame it fills.
struct BgrPicture {
    const std::uint8_t* data;
    std::ptrdiff_t stride_bytes;
    ChannelOrder order = ChannelOrder::kBlueGreenRed;  ///< in memory
};

/// Planes of a decoded JPEG. Chroma of pixel (x, y) is at (x >> shift_x, y >> shift_y).
struct YuvPicture {
    std::array<hal::Plane, 3> planes;  ///< without chroma: data of planes 1 and 2 is null
    int chroma_shift_x;
    int chroma_shift_y;
};

/// Full-range BT.601 (JPEG) NV12, chroma averaged over 2 x 2 pixels. Integer: the same on every
/// machine.
void ToNv12(const BgrPicture& picture, const hal::FrameFormat& format,
            std::span<std::uint8_t> nv12);
void ToNv12(const YuvPicture& picture, const hal::FrameFormat& format,
            std::span<std::uint8_t> nv12);

}  // namespace hitchview::drivers
