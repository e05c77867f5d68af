#pragma once

#include <cstdint>
#include <span>

#include "hal/frame.hpp"

namespace hitchview::hal {

/// Where seams and meshes lie on a panorama, borrowed for the call. Pixels; (0, 0) is the centre of
/// the top left one.
struct Overlay {
    std::uint32_t sequence = 0;  ///< of the panorama that it belongs to
    Instant captured_from{};
    int width_px = 0;  ///< of the panorama
    int height_px = 0;
    int mesh_rows = 0;  ///< vertices from top to bottom
    int mesh_cols = 0;
    /// Row by row, first the tractor's, then the trailer's; not a number where a view has no pixel.
    std::span<const float> mesh_x{};
    std::span<const float> mesh_y{};
    /// Places from top to bottom where the seams are told; none for one unit.
    std::span<const float> seam_y{};
    std::span<const float> left_seam_x{};
    std::span<const float> right_seam_x{};
};

}  // namespace hitchview::hal
