#pragma once

#include "algo/panorama_block.hpp"

namespace hitchview::algo {

/// Samples of a block's side, and their lanes in its rows: luma's, or colour's at half the size
/// with u's before v's.
inline constexpr int kBlockLanes = ComposedMap::kBlock;

/// A camera moves by no more than this over a block, px: what it shows of a row fits into the
/// kernel's window.
inline constexpr float kKernelReach_px = 15;
/// Nor does the kernel read nearer to the edge of a picture, nor smaller pictures.
inline constexpr float kKernelMargin_px = 0.75F;
inline constexpr int kKernelLeast_px = 32;

/// Makes the pixels of a block that has sources, all of them within the limits above, with weights
/// that add up to 1 at each corner if there are several. Fixed point: the same on every instruction
/// set, and within one grey level of the exact bilinear value. False, and nothing done, where the
/// processor has no vector instructions.
bool DrawBlock(const PanoramaBlock& block, const PanoramaPlanes& out);

}  // namespace hitchview::algo
