#pragma once

#include <span>

#include "algo/panorama_block.hpp"

namespace hitchview::algo {

/// A camera moves by no more than this over a block, px: what it shows of a row fits into the
/// kernel's window.
inline constexpr float kKernelReach_px = 15;
/// Nor does the kernel read nearer to the edge of a picture, nor smaller pictures.
inline constexpr float kKernelMargin_px = 0.75F;
inline constexpr int kKernelLeast_px = 32;

/// Sets the windows of a source within the limits above. False, and nothing done, where the
/// processor has no vector instructions.
bool PlaceSource(BlockSource& source);

/// Makes the pixels of those blocks that suit the kernel: within one grey level of the exact
/// bilinear value. Fixed point: the same on every instruction set.
void DrawBlocks(std::span<const PanoramaBlock> blocks, const PanoramaPlanes& out);

}  // namespace hitchview::algo
