#pragma once

#include <array>
#include <cstdint>

#include "algo/camera_frame.hpp"
#include "algo/composed_map.hpp"
#include "algo/multiband_blend.hpp"
#include "algo/task_runner.hpp"

namespace hitchview::algo {

/// A picture that is being made: planar 4:2:0, full range, even size. Borrowed memory.
struct PanoramaPlanes {
    int width_px = 0;
    int height_px = 0;
    std::uint8_t* y = nullptr;
    int y_stride_bytes = 0;
    std::uint8_t* u = nullptr;
    std::uint8_t* v = nullptr;
    int chroma_stride_bytes = 0;
};

/// What stands where no camera gives a pixel.
enum class NoData {
    kBlack,    ///< pure black: views before blending
    kPattern,  ///< black where nothing is calibrated or shifted in; hatched where a camera is
               ///< missing
};

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
    using Lut = std::array<std::uint8_t, 256>;
    struct CameraLut {
        Lut luma;
        Lut chroma;
    };
    /// What is made into a picture.
    struct Scene {
        const ComposedMap& map;
        const RigFrames& frames;
        const MultibandBlend* bands;  ///< null: every pixel as the cameras show it
        NoData no_data;
    };
    struct BlockSource;
    struct Block;

    void RenderBlockRow(const Scene& scene, const PanoramaPlanes& out, int row) const;
    bool Gather(const Scene& scene, int row, int col, Block& block) const;

    PerUnit<std::array<CameraLut, kMaxCameras>> luts_;
};

}  // namespace hitchview::algo
