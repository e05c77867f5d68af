#include "app/bench_memory.hpp"

#include <malloc.h>

#include <memory>

#include "algo/multiband_blend.hpp"
#include "algo/picture_reduction.hpp"
#include "algo/unified_options.hpp"
#include "algo/unified_vertex_motion.hpp"
#include "app/jpeg_encoder.hpp"
#include "hal/frame_pool.hpp"

namespace hitchview::app {
namespace {

/// Buffers of PanoramaPublisher.
constexpr int kPublished = 4;

std::size_t BytesInUse() {
    const struct mallinfo2 heap = mallinfo2();
    return heap.uordblks + heap.hblkhd;
}

/// Makes something and notes what that took.
template <typename Make>
auto Noted(const char* name, std::vector<MemoryPart>& parts, Make&& make) {
    const std::size_t before = BytesInUse();
    auto made = make();
    parts.push_back({name, BytesInUse() - before});
    return made;
}

int Cameras(const RigGeometry& geometry) {
    int cameras = 0;
    for (const algo::Unit unit : algo::kUnits)
        cameras += geometry.units[unit] ? geometry.units[unit]->cameras() : 0;
    return cameras;
}

}  // namespace

std::vector<MemoryPart> MemoryOf(const RigGeometry& geometry, const hal::FrameFormat& frame,
                                 int held_sets) {
    const algo::Projection& canvas = geometry.canvas;
    const hal::FrameFormat panorama{canvas.width_px, canvas.height_px, hal::PixelFormat::kI420,
                                    hal::Range::kFull};
    std::vector<MemoryPart> parts;
    parts.reserve(8);
    const auto cameras = Noted("camera frames", parts, [&] {
        return std::make_unique<hal::FramePool>(frame, held_sets * Cameras(geometry));
    });
    const auto motion = Noted("estimation", parts, [&] {
        return std::make_unique<algo::UnifiedVertexMotion>(canvas, geometry.units,
                                                           algo::UnifiedVertexMotionOptions{});
    });
    const auto map = Noted("composed map and seams", parts, [&] {
        return std::make_unique<algo::ComposedMap>(canvas, geometry.units,
                                                   algo::SeamOptionsOf(canvas));
    });
    const auto reduced = Noted("reduced pictures", parts, [&] {
        return std::make_unique<algo::PictureReduction>(geometry.units);
    });
    const auto bands = Noted("bands of the joints", parts,
                             [&] { return std::make_unique<algo::MultibandBlend>(*map); });
    const auto shown = Noted("panoramas", parts, [&] {
        return std::make_unique<hal::FramePool>(panorama, 2 + kPublished);
    });
    const auto jpeg = Noted("compression", parts, [&] {
        return std::make_unique<JpegEncoder>(panorama, JpegQualityGovernorOptions{});
    });
    return parts;
}

}  // namespace hitchview::app
