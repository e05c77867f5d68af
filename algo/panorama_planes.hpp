#pragma once

#include <cstdint>

namespace hitchview::algo {

/// A picture that is being made: planar 4:2:0, full range, even size. Borrowed memory.
struct PanoramaPlanes {
    int width_px = 0;
    int height_px = 0;
    std::uint8_t* y = nullptr;
    int y_stride_bytes = 0;
    std::uint8_t* u = nullptr;
    std::uint8_t* v = nullptr;
    int chroma_stride_bytes = 0;
};

/// What stands where no camera gives a pixel.
enum class NoData {
    kBlack,    ///< pure black: views before blending
    kPattern,  ///< black where nothing is calibrated or shifted in; hatched where a camera is
               ///< missing
};

}  // namespace hitchview::algo
