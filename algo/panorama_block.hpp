#pragma once

#include <array>

#include "algo/camera_sampler.hpp"
#include "algo/composed_map.hpp"
#include "algo/fixed_vector.hpp"
#include "algo/panorama_planes.hpp"

namespace hitchview::algo {

/// Values at the corners of a block: top left, top right, bottom left, bottom right.
using Corners = std::array<float, 4>;

/// One camera's part in a block of the panorama.
struct BlockSource {
    const CameraSampler* camera;
    Corners x;  ///< where the camera is read, px
    Corners y;
    Corners weight;
    std::array<Corners, 3> shift;  ///< added to luma, u and v; only if `shifted`
    bool shifted;

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
    int x = 0;  ///< top left canvas pixel
    int y = 0;
    int width = ComposedMap::kBlock;  ///< less at the right and lower edge of the canvas; even
    int height = ComposedMap::kBlock;
    FixedVector<BlockSource, kMaxCameras> sources;
    bool camera_missing = false;  ///< one that would be seen here gave no picture

    /// No more than one camera's, all over.
    [[nodiscard]] bool IsPlain() const {
        return sources.size() == 1 && !camera_missing && sources[0].SeesAll();
    }
    /// Makes the pixels of the block.
    void Render(NoData no_data, const PanoramaPlanes& out);

 private:
    [[nodiscard]] bool SuitsKernel() const;
    bool NormalizeWeights();
};

}  // namespace hitchview::algo
