#pragma once

#include <array>
#include <cstdint>

#include "algo/camera_frame.hpp"

namespace hitchview::algo {

/// What can be said of one camera's picture from a sparse look at its luma: how bright it is, and
/// how much changes from pixel to pixel in each part of it.
struct PictureLook {
    static constexpr int kCols = 8;
    static constexpr int kRows = 6;
    static constexpr std::size_t kCells = static_cast<std::size_t>(kCols * kRows);

    /// Mean squared differences of grey levels between pixels of a row, at distances in the ratio
    /// of 1 to 8 (4 where the picture is narrower than 640): the structure function of turbulence
    /// and texture. A sharp picture's grows with the distance, or less; a smooth one's with its
    /// square.
    struct Cell {
        float fine = 0;
        float coarse = 0;
    };

    float mean = 0;          ///< grey level, 0..255
    float dark_share = 0;    ///< of the samples, at most kDark; 0..1
    float bright_share = 0;  ///< of the samples, at least kBright; 0..1
    std::uint64_t print = 0;  ///< equal for equal samples, all but surely different otherwise
    std::array<Cell, kCells> cells{};  ///< row by row

    static constexpr float kDark = 20;
    static constexpr float kBright = 250;
};

/// Some 7000 samples, whatever the size of the picture (at least 64 x 48). Takes no memory.
PictureLook LookAt(const CameraFrame& picture);

/// Of every luma sample: equal for equal pictures, all but surely different otherwise.
std::uint64_t PrintOf(const CameraFrame& picture);

}  // namespace hitchview::algo
