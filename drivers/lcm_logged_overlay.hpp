#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "hal/frame.hpp"
#include "hal/result.hpp"

namespace hitchview::drivers {

inline constexpr int kMostOverlayRows = 256;  ///< of a mesh; as many columns
inline constexpr int kMostSeamRows = 4096;

/// A hitchview.overlay_t, read without trust; its contract stands in lcmtypes/.
struct LoggedOverlay {
    std::uint32_t sequence = 0;
    std::int64_t utime_us = 0;
    hal::Instant captured_at{};
    int width_px = 0;                ///< [1, 16384]
    int height_px = 0;               ///< [1, 16384]
    int mesh_rows = 0;               ///< [0, kMostOverlayRows]
    int mesh_columns = 0;            ///< [0, kMostOverlayRows]
    std::vector<float> mesh_x_px{};  ///< 2 * mesh_rows * mesh_columns; not a number: no vertex
    std::vector<float> mesh_y_px{};
    std::vector<float> seam_y_px{};  ///< at most kMostSeamRows
    std::vector<float> left_seam_x_px{};
    std::vector<float> right_seam_x_px{};
};

/// kCorrupted: wrong type; a count that is negative, too large or does not fit the others; bytes
/// left over; a side outside its range.
hal::Result<LoggedOverlay> ParseLoggedOverlay(std::span<const std::uint8_t> message);

}  // namespace hitchview::drivers
