#pragma once

#include <span>

#include "algo/panorama_block.hpp"

namespace hitchview::algo {

/// A camera moves by no more than this over a segment, px: what it shows of it fits into the
/// kernel's window.
inline constexpr float kKernelReach_px = 15;
/// Where a source is read nearer to the edge of its picture, the kernel looks at what is seen.
inline constexpr float kKernelMargin_px = 0.75F;
/// It reads no source whose corners lie farther outside its picture, nor smaller pictures.
inline constexpr float kKernelOutside_px = 64;
inline constexpr int kKernelLeast_px = 32;

/// False where the processor has no vector instructions.
bool KernelRuns();

/// Makes the pixels of those blocks that suit the kernel: within one grey level of the exact
/// bilinear value. Fixed point: the same on every instruction set. Sets the windows of the sources.
/// The blocks are of one size.
void DrawBlocks(std::span<PanoramaBlock> blocks, const PanoramaPlanes& out);

}  // namespace hitchview::algo
