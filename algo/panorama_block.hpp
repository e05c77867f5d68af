#pragma once

#include <array>

#include "algo/camera_sampler.hpp"
#include "algo/composed_map.hpp"
#include "algo/fixed_vector.hpp"
#include "algo/panorama_planes.hpp"

namespace hitchview::algo {

/// Values at the corners of a block: top left, top right, bottom left, bottom right.
using Corners = std::array<float, 4>;

inline constexpr int kBlockLanes = ComposedMap::kBlock;

/// Where the vector kernel reads the rows of a block along one axis: at window[r] + first[r] +
/// i * step[r], the latter two in 1/4096 samples.
struct WindowAxis {
    alignas(16) std::array<std::uint16_t, kBlockLanes> first;
    alignas(16) std::array<std::int16_t, kBlockLanes> step;
    alignas(32) std::array<std::int32_t, kBlockLanes> window;  ///< first sample that is loaded
    int count;  ///< of samples in a row's window; the same for all rows
};
struct SampleWindows {
    WindowAxis x;
    WindowAxis y;
};

/// One camera's part in a block of the panorama.
struct BlockSource {
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
    /// The vector kernel can read the block: it lies inside the picture and is not reduced too
    /// much.
    [[nodiscard]] bool SuitsKernel() const;
};

/// A square of ComposedMap::kBlock pixels of the panorama, and what is seen in it; between its
/// corners everything is bilinear.
struct PanoramaBlock {
    int x = 0;  ///< its top left pixel in the planes it is drawn to
    int y = 0;
    int phase_px = 0;  ///< of the pattern where a camera is missing: canvas x + y of that pixel
    int width = ComposedMap::kBlock;  ///< less at the right and lower edge of the canvas; even
    int height = ComposedMap::kBlock;
    FixedVector<BlockSource, kMaxCameras> sources;
    bool camera_missing = false;  ///< one that would be seen here gave no picture

    /// No more than one camera's, all over.
    [[nodiscard]] bool IsPlain() const {
        return sources.size() == 1 && !camera_missing && sources[0].SeesAll();
    }
    /// To be called when the sources have been set.
    void Prepare();
    /// Its pixels can be made by the vector kernel: it has sources, all of them placed, with
    /// weights that add up to 1 at each corner if there are several.
    [[nodiscard]] bool suits_kernel() const { return suits_kernel_; }
    /// Makes the pixels of a block that does not suit the kernel, one by one.
    void RenderPixels(NoData no_data, const PanoramaPlanes& out) const;

 private:
    [[nodiscard]] bool SourcesSuitKernel() const;
    bool NormalizeWeights();
    bool PlaceSources();

    bool suits_kernel_ = false;
};

}  // namespace hitchview::algo
