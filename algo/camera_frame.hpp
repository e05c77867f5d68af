#pragma once

#include <array>
#include <cstdint>

#include "algo/unit.hpp"
#include "algo/unit_geometry.hpp"

namespace hitchview::algo {

/// Borrowed pixels of one camera, full-range NV12: Y, and interleaved U V at half size.
/// A camera that gave no picture has luma == nullptr.
struct CameraFrame {
    int width_px = 0;
    int height_px = 0;
    const std::uint8_t* luma = nullptr;
    int luma_stride_bytes = 0;
    const std::uint8_t* chroma = nullptr;
    int chroma_stride_bytes = 0;

    [[nodiscard]] bool present() const { return luma != nullptr; }
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
