#include "algo/block_kernel.hpp"

#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "algo/block_kernel.cpp"
#include <hwy/cache_control.h>
#include <hwy/foreach_target.h>
#include <hwy/highway.h>

#include "algo/block_drawing-inl.hpp"

HWY_BEFORE_NAMESPACE();
namespace hitchview::algo::HWY_NAMESPACE {

#if HWY_TARGET == HWY_SCALAR

bool KernelRunsHere() {
    return false;
}
void DrawBlocksHere(std::span<PanoramaBlock> /*blocks*/, const PanoramaPlanes& /*out*/) {}

#else

bool KernelRunsHere() {
    return true;
}

SampleGrid GridOf(const SamplePlane& plane) {
    return {plane.cols, plane.rows, plane.step_bytes, plane.stride_bytes};
}

/// Asks for what will be read: a processor foresees few of so many rows.
template <int kSamples, int kParts>
HWY_INLINE void Prefetch(const Samples& plane, const SampleWindows& windows) {
    constexpr int kSegments = SegmentTable<kSamples, kParts>::kSegments;
    for (std::size_t s = 0; s < kSegments; ++s)
        hwy::Prefetch(plane.begin + windows.offset_bytes[s] + plane.stride_bytes);
}

template <int kParts>
HWY_INLINE void PlaceSource(bool on_edge, BlockSource& source) {
    const CameraFrame& frame = source.camera->frame();
    if (on_edge) {
        FindSeen<8, kParts>(source.x, source.y, frame, source.luma);
        FindSeen<4, kParts>(source.x, source.y, frame, source.chroma);
    }
    PlaceBlock<8, kParts>(source.x, source.y, GridOf(frame.LumaSamples()), source.luma);
    Prefetch<8, kParts>(LumaOf(frame), source.luma);
    if (!frame.has_chroma()) return;
    Corners x;
    Corners y;
    for (std::size_t k = 0; k < x.size(); ++k) {
        x[k] = CameraFrame::ChromaX(source.x[k]);
        y[k] = frame.ChromaY(source.y[k]);
    }
    PlaceBlock<4, kParts>(x, y, GridOf(frame.ChromaSamples(0)), source.chroma);
    if (!frame.is_packed()) Prefetch<4, kParts>(ChromaOf(frame), source.chroma);
}

/// Blocks of one size.
template <int kParts>
void DrawAll(std::span<PanoramaBlock> blocks, const PanoramaPlanes& out) {
    for (PanoramaBlock& block : blocks) {
        if (!block.suits_kernel()) continue;
        for (BlockSource& source : block.sources) PlaceSource<kParts>(block.on_edge(), source);
    }
    for (const PanoramaBlock& block : blocks) {
        if (block.suits_kernel()) Drawing<LumaKind, kParts>(block, out);
    }
    for (const PanoramaBlock& block : blocks) {
        if (block.suits_kernel()) Drawing<ChromaKind, kParts>(block, out);
    }
}

void DrawBlocksHere(std::span<PanoramaBlock> blocks, const PanoramaPlanes& out) {
    if (blocks.empty()) return;
    if (blocks[0].side_px == kSegmentLanes) {
        DrawAll<1>(blocks, out);
    } else {
        DrawAll<2>(blocks, out);
    }
}

#endif  // HWY_TARGET == HWY_SCALAR

}  // namespace hitchview::algo::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace hitchview::algo {
namespace {
HWY_EXPORT(KernelRunsHere);
HWY_EXPORT(DrawBlocksHere);
}  // namespace

bool KernelRuns() {
    return HWY_DYNAMIC_DISPATCH(KernelRunsHere)();
}

void DrawBlocks(std::span<PanoramaBlock> blocks, const PanoramaPlanes& out) {
    HWY_DYNAMIC_DISPATCH(DrawBlocksHere)(blocks, out);
}

}  // namespace hitchview::algo
#endif
