#pragma once

#include <cstdint>
#include <span>
#include <vector>

namespace hitchview::app {

/// Makes one baseline JPEG of JPEGs of its bands from top to bottom, which were compressed with the
/// same tables, width and restart interval: that of all bands but the last, which may be shorter.
/// Works in place: `bands` lie in `memory`, in this order and apart, the first at its start.
/// Returns the JPEG, at the start of `memory`. `height_px`: of the whole picture, at most 65535.
std::span<std::uint8_t> JoinJpegBands(std::span<std::uint8_t> memory,
                                      std::span<const std::span<std::uint8_t>> bands,
                                      int height_px);

}  // namespace hitchview::app
