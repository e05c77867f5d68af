#pragma once

#include <cstddef>

namespace hitchview::app {

/// Median time of copying so many bytes from one place to another, on one thread; ms.
double MemcpyMs(std::size_t bytes);

/// Median time of OpenCV's remap of a colour picture of camera size to a panorama of this size, on
/// one thread: BGR, bilinear, fixed-point maps. ms.
double RemapMs(int camera_width_px, int camera_height_px, int width_px, int height_px);

}  // namespace hitchview::app
