#pragma once

#include <array>

#include "algo/multiband_blend.hpp"
#include "algo/panorama_block.hpp"
#include "algo/task_runner.hpp"

namespace hitchview::algo {

/// Makes the output picture: every pixel is read once, bilinear, straight from the camera frames
/// (reduced ones included);
/// where cameras or units are blended, once from each of them. Bit-identical on any number of
/// tasks.
class PanoramaRenderer {
 public:
    PanoramaRenderer() { SetGains({}); }

    /// Gains in (0.25, 4); others count as 1.
    void SetGains(const CameraGains& gains) { gains_ = gains; }

    void Render(const ComposedMap& map, const RigFrames& frames, NoData no_data,
                const PanoramaPlanes& out, TaskRunner& runner) const;
    /// The same with coarse detail blended wider than fine detail; pattern where there is no data.
    void RenderBlended(const ComposedMap& map, const RigFrames& frames, const MultibandBlend& bands,
                       const PanoramaPlanes& out, TaskRunner& runner) const;

 private:
    /// The pictures of a map's sources; one without a picture is not present.
    using Samplers = FixedVector<CameraSampler, 2 * kMaxCameras>;
    /// What is made into a picture.
    struct Scene {
        const ComposedMap& map;
        const Samplers& cameras;
        const MultibandBlend* bands;  ///< null: every pixel as the cameras show it
        NoData no_data;
    };

    struct Strip;

    [[nodiscard]] Samplers SamplersOf(const ComposedMap& map, const RigFrames& frames) const;
    static void Gather(const Scene& scene, int row, int col, unsigned sources,
                       PanoramaBlock& block);
    static void RenderRow(const Scene& scene, const PanoramaPlanes& out, int row);
    static void GatherStrip(const Scene& scene, int row, int first_col, Strip& strip);

    CameraGains gains_;
};

}  // namespace hitchview::algo
