#pragma once

#include <array>

#include "algo/multiband_blend.hpp"
#include "algo/panorama_block.hpp"
#include "algo/task_runner.hpp"

namespace hitchview::algo {

/// Makes the output picture: every pixel is read once, bilinear, straight from the camera frames;
/// where cameras or units are blended, once from each of them. Bit-identical on any number of
/// tasks.
class PanoramaRenderer {
 public:
    PanoramaRenderer() { SetGains({{{{}, {}}}}); }

    /// Gains in (0.25, 4); others count as 1.
    void SetGains(const CameraGains& gains);

    void Render(const ComposedMap& map, const RigFrames& frames, NoData no_data,
                const PanoramaPlanes& out, TaskRunner& runner) const;
    /// The same with coarse detail blended wider than fine detail; pattern where there is no data.
    void RenderBlended(const ComposedMap& map, const RigFrames& frames, const MultibandBlend& bands,
                       const PanoramaPlanes& out, TaskRunner& runner) const;

 private:
    /// What is made into a picture.
    struct Scene {
        const ComposedMap& map;
        const RigFrames& frames;
        const MultibandBlend* bands;  ///< null: every pixel as the cameras show it
        NoData no_data;
    };

    void RenderBlockRow(const Scene& scene, const PanoramaPlanes& out, int row) const;
    void Gather(const Scene& scene, int row, int col, PanoramaBlock& block) const;

    PerUnit<std::array<CameraLut, kMaxCameras>> luts_;
};

}  // namespace hitchview::algo
