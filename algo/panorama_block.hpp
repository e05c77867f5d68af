#pragma once

#include <array>

#include "algo/camera_sampler.hpp"
#include "algo/composed_map.hpp"
#include "algo/fixed_vector.hpp"
#include "algo/panorama_planes.hpp"

namespace hitchview::algo {

/// Values at the corners of a block: top left, top right, bottom left, bottom right.
using Corners = std::array<float, 4>;

/// Lanes of the vector kernel: a block is drawn in segments, 8 px of a row each, or 4 of both
/// colour channels.
inline constexpr int kSegmentLanes = 8;
/// A block has at most so many px to a side, and segments.
inline constexpr int kMaxBlock_px = 16;
inline constexpr int kMaxSegments = kMaxBlock_px * kMaxBlock_px / kSegmentLanes;

/// What is linear along each of a block's segments: first[s] + i * step[s]; fixed point.
struct SegmentLines {
    alignas(64) std::array<std::uint16_t, kMaxSegments> first;
    alignas(64) std::array<std::int16_t, kMaxSegments> step;
};

/// Where the vector kernel reads a block: in a window of each segment's own, `rows` high.
struct SampleWindows {
    SegmentLines x;  ///< from the window's first sample, in 1/4096 samples
    SegmentLines y;
    alignas(64) std::array<std::int32_t, kMaxSegments> offset_bytes;  ///< the window's
    int rows;
    /// Bit i: sample i lies in the picture. Only of a block on a picture's edge; elsewhere all do.
    alignas(64) std::array<std::uint16_t, kMaxSegments> seen;
};

/// One camera's part in a block of the panorama.
struct BlockSource {
    // Blocks are gathered into memory that need not be cleared first.
    BlockSource() {}  // NOLINT(modernize-use-equals-default)

    const CameraSampler* camera;
    Corners x;  ///< where the camera is read, px
    Corners y;
    Corners weight;
    std::array<Corners, 3> shift;  ///< added to luma, u and v; only if `shifted`
    bool shifted;
    SampleWindows luma;  ///< of a block that is drawn by the kernel
    SampleWindows chroma;

    /// The whole block lies inside the camera's picture, `margin_px` from its edge: its four
    /// corners do.
    [[nodiscard]] bool SeesAll(float margin_px = 0) const;
    /// All of the block lies to one side of the camera's picture.
    [[nodiscard]] bool LiesBeside() const;
    /// The vector kernel can read a block of so many px: it is not reduced too much.
    [[nodiscard]] bool SuitsKernel(int side_px) const;
};

/// A square of the panorama, and what is seen in it; between its corners everything is bilinear.
struct PanoramaBlock {
    int x = 0;  ///< its top left pixel in the planes it is drawn to
    int y = 0;
    int phase_px = 0;            ///< of the pattern where a camera is missing: canvas x + y
    int side_px = kMaxBlock_px;  ///< kSegmentLanes or kMaxBlock_px
    FixedVector<BlockSource, kMaxCameras> sources;
    bool camera_missing = false;  ///< one that would be seen here gave no picture

    /// To be called when the sources have been set.
    void Prepare();
    /// Its pixels can be made by the vector kernel.
    [[nodiscard]] bool suits_kernel() const { return suits_kernel_; }
    /// Some of its pixels may not be seen by all of its sources, or by none, and the weights of
    /// those that see a pixel need not add up to 1.
    [[nodiscard]] bool on_edge() const { return on_edge_; }
    [[nodiscard]] bool IsEmpty() const { return sources.empty() && !camera_missing; }
    /// One of its quarters, as a prepared block of half the size.
    void TakeQuarter(const PanoramaBlock& whole, int down, int across);
    /// Makes the pixels of an empty block.
    void Clear(const PanoramaPlanes& out) const;
    /// Makes the pixels of a block that does not suit the kernel, one by one. Requires side_px ==
    /// kSegmentLanes.
    void RenderPixels(NoData no_data, const PanoramaPlanes& out) const;

 private:
    [[nodiscard]] bool SourcesSuitKernel() const;
    [[nodiscard]] bool SourcesSeeAll() const;
    bool NormalizeWeights();

    bool suits_kernel_ = false;
    bool on_edge_ = false;
};

}  // namespace hitchview::algo
