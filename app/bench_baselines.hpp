#pragma once

#include <cstddef>

#include "app/bench_frames.hpp"

namespace hitchview::app {

/// Median time of copying the pictures of a frame set, and a panorama of so many bytes, on one
/// thread; ms. As in a run, each set lies in another place and was not looked at lately.
double MemcpyMs(const BenchFrames& frames, std::size_t panorama_bytes);

/// Median time of OpenCV's remap of a colour picture of camera size to a panorama of this size, on
/// one thread: BGR, bilinear, fixed-point maps. ms.
double RemapMs(int camera_width_px, int camera_height_px, int width_px, int height_px);

}  // namespace hitchview::app
