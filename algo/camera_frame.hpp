#pragma once

#include <array>
#include <cstddef>
#include <cstdint>

#include "algo/unit.hpp"
#include "algo/unit_geometry.hpp"

namespace hitchview::algo {

/// How the samples of a picture lie in memory.
enum class PixelLayout : std::uint8_t {
    kNv12,  ///< luma: Y; chroma: U V at half the width and height
    kUyvy,  ///< luma and chroma are one plane: U Y V Y, two pixels in four bytes
    kYuyv,  ///< luma and chroma are one plane: Y U Y V
    kGrey,  ///< luma: Y; without colour
};

/// What the bytes stand for. Full: 0..255. Limited: luma 16..235, chroma 16..240.
enum class SampleRange : std::uint8_t { kFull, kLimited };

/// Grey level 0..255 of a luma value, and distance from grey of a chroma value less 128; both may
/// leave 0..255 where a limited value leaves its range.
constexpr float FullLuma(SampleRange range, float luma) {
    return range == SampleRange::kFull ? luma : (luma - 16.0F) * (255.0F / 219.0F);
}
constexpr float FullChroma(SampleRange range, float chroma_less_128) {
    return range == SampleRange::kFull ? chroma_less_128 : chroma_less_128 * (255.0F / 224.0F);
}

/// The samples of one channel. Borrowed.
struct SamplePlane {
    const std::uint8_t* first = nullptr;
    int stride_bytes = 0;
    int step_bytes = 1;  ///< from one sample to the next in its row
    int cols = 0;
    int rows = 0;

    [[nodiscard]] const std::uint8_t* row(int y) const {
        return first + static_cast<std::ptrdiff_t>(y) * stride_bytes;
    }
};

/// Borrowed pixels of one camera; even size. A camera that gave no picture has luma == nullptr.
struct CameraFrame {
    int width_px = 0;
    int height_px = 0;
    const std::uint8_t* luma = nullptr;
    int luma_stride_bytes = 0;
    const std::uint8_t* chroma = nullptr;  ///< packed layouts: the same as luma; kGrey: not read
    int chroma_stride_bytes = 0;
    PixelLayout layout = PixelLayout::kNv12;
    SampleRange range = SampleRange::kFull;
    int side = 1;  ///< pixels of the camera to one of these, each way (see PictureReduction)

    [[nodiscard]] bool present() const { return luma != nullptr; }
    [[nodiscard]] bool has_chroma() const { return layout != PixelLayout::kGrey; }
    [[nodiscard]] bool is_packed() const {
        return layout == PixelLayout::kUyvy || layout == PixelLayout::kYuyv;
    }

    [[nodiscard]] SamplePlane LumaSamples() const {
        const int at = layout == PixelLayout::kUyvy ? 1 : 0;
        return {luma + at, luma_stride_bytes, is_packed() ? 2 : 1, width_px, height_px};
    }
    /// Channel 0: U, 1: V. Half as wide as luma; packed layouts have a row of them for each of
    /// luma, the others for every second. Requires has_chroma().
    [[nodiscard]] SamplePlane ChromaSamples(int channel) const {
        const int first = layout == PixelLayout::kYuyv ? 1 : 0;
        const int step = is_packed() ? 2 : 1;
        return {chroma + first + channel * step, chroma_stride_bytes, 2 * step, width_px / 2,
                is_packed() ? height_px : height_px / 2};
    }
    /// Where a pixel of the camera lies in this picture, each way.
    [[nodiscard]] float Reduced(float camera_px) const {
        return side == 1 ? camera_px : (camera_px + 0.5F) / static_cast<float>(side) - 0.5F;
    }
    /// Where luma's pixel (x, y) lies among the samples of ChromaSamples.
    [[nodiscard]] static float ChromaX(float luma_x) { return 0.5F * luma_x - 0.25F; }
    [[nodiscard]] float ChromaY(float luma_y) const {
        return is_packed() ? luma_y : 0.5F * luma_y - 0.25F;
    }
};

/// The pictures of one moment, by unit and camera of the unit.
using UnitFrames = std::array<CameraFrame, kMaxCameras>;
using RigFrames = PerUnit<UnitFrames>;

/// Brightness of each camera relative to the others; multiplies grey and colour.
using CameraGains = PerUnit<std::array<float, kMaxCameras>>;

/// What the cameras saw, and how bright it is to be shown. Borrowed.
struct RigPictures {
    const RigFrames& frames;
    const CameraGains& gains;
};

}  // namespace hitchview::algo
