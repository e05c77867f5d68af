#include "algo/panorama_renderer.hpp"

#include <algorithm>
#include <bit>
#include <cstring>
#include <span>

#include "algo/block_kernel.hpp"

namespace hitchview::algo {
namespace {

constexpr int kStrip_px = 128;
constexpr int kMaxStrip = kStrip_px / kSegmentLanes;  // blocks

/// Memory for the pixels of a strip of blocks.
class StripPicture {
 public:
    [[nodiscard]] PanoramaPlanes planes() {
        return {kWidth, kHeight, y_.data(), kWidth, u_.data(), v_.data(), kWidth / 2};
    }
    /// Its first `rows` to the canvas with their top left pixel at (x, y), as far as it lies on it.
    void CopyTo(const PanoramaPlanes& out, int x, int y, int rows) const {
        const int width = std::min(kWidth, out.width_px - x);
        const int height = std::min(rows, out.height_px - y);
        const auto chroma_at = static_cast<std::ptrdiff_t>(y / 2) * out.chroma_stride_bytes + x / 2;
        CopyRows<kWidth>(y_.data(), width, height,
                         out.y + static_cast<std::ptrdiff_t>(y) * out.y_stride_bytes + x,
                         out.y_stride_bytes);
        CopyRows<kWidth / 2>(u_.data(), width / 2, height / 2, out.u + chroma_at,
                             out.chroma_stride_bytes);
        CopyRows<kWidth / 2>(v_.data(), width / 2, height / 2, out.v + chroma_at,
                             out.chroma_stride_bytes);
    }

 private:
    static constexpr int kWidth = kStrip_px;
    static constexpr int kHeight = kMaxBlock_px;

    template <int kBytes>
    static void CopyRows(const std::uint8_t* from, int bytes, int rows, std::uint8_t* to,
                         int stride_bytes) {
        for (int r = 0; r < rows; ++r) {
            if (bytes == kBytes) {
                std::memcpy(to, from, kBytes);
            } else {
                std::memcpy(to, from, static_cast<std::size_t>(bytes));
            }
            from += kBytes;
            to += stride_bytes;
        }
    }

    alignas(64) std::array<std::uint8_t, kWidth * kHeight> y_;
    alignas(64) std::array<std::uint8_t, kWidth * kHeight / 4> u_;
    alignas(64) std::array<std::uint8_t, kWidth * kHeight / 4> v_;
};

/// Which sources of the map are seen in some blocks of a row; bit s is source s.
class BlockSources {
 public:
    BlockSources(const ComposedMap& map, int row, int first_col, int cols) {
        for (int s = 0; s < map.cameras(); ++s) {
            const ComposedMap::Corner* upper = &map.corner(s, row, first_col);
            const ComposedMap::Corner* lower = &map.corner(s, row + 1, first_col);
            const auto reaches = [&](const ComposedMap::Columns& used) {
                return used.first <= first_col + cols && used.last >= first_col;
            };
            if (reaches(map.used(s, row)) || reaches(map.used(s, row + 1)))
                Add(s, upper, lower, cols);
        }
    }

    /// Of block `i` of them: those with a share at one of its corners, and a place in the
    /// camera at all four.
    [[nodiscard]] unsigned of(int i) const {
        const auto at = static_cast<std::size_t>(i);
        return (used_[at] | used_[at + 1]) & seen_[at] & seen_[at + 1];
    }

 private:
    void Add(int s, const ComposedMap::Corner* upper, const ComposedMap::Corner* lower, int cols) {
        for (int i = 0; i <= cols; ++i) {
            const auto at = static_cast<std::size_t>(i);
            const bool used = upper[i].weight > 0 || lower[i].weight > 0;
            used_[at] |= static_cast<unsigned>(used) << s;
            seen_[at] |= static_cast<unsigned>(upper[i].sees && lower[i].sees) << s;
        }
    }

    std::array<unsigned, kMaxStrip + 1> used_{};
    std::array<unsigned, kMaxStrip + 1> seen_{};
};

void ReadCorners(const ComposedMap& map, int s, int row, int col, BlockSource& source) {
    const ComposedMap::Corner* upper = &map.corner(s, row, col);
    const ComposedMap::Corner* lower = &map.corner(s, row + 1, col);
    const CameraFrame& frame = source.camera->frame();
    source.x = {frame.Reduced(upper[0].x), frame.Reduced(upper[1].x), frame.Reduced(lower[0].x),
                frame.Reduced(lower[1].x)};
    source.y = {frame.Reduced(upper[0].y), frame.Reduced(upper[1].y), frame.Reduced(lower[0].y),
                frame.Reduced(lower[1].y)};
    source.weight = {upper[0].weight, upper[1].weight, lower[0].weight, lower[1].weight};
}

/// False where the shift is too small to show.
bool ShiftSource(const MultibandBlend& bands, int s, int row, int col, BlockSource& source) {
    constexpr float kLeast = 0.25F;
    float most = 0;
    for (std::size_t k = 0; k < 4; ++k) {
        const MultibandBlend::Colour colour =
            bands.shift(s, row + static_cast<int>(k / 2), col + static_cast<int>(k % 2));
        most = std::max(most, colour.abs().maxCoeff());
        for (std::size_t channel = 0; channel < 3; ++channel)
            source.shift[channel][k] = colour[static_cast<int>(channel)];
    }
    return most > kLeast;
}

/// Makes the pixels of a block that the kernel cannot make as a whole.
void RenderPixels(const PanoramaBlock& block, NoData no_data, const PanoramaPlanes& out) {
    if (block.IsEmpty()) {
        block.Clear(out);
        return;
    }
    if (block.side_px == kSegmentLanes) {
        block.RenderPixels(no_data, out);
        return;
    }
    PanoramaBlock quarter;
    for (const int i : {0, 1, 2, 3}) {
        quarter.TakeQuarter(block, i / 2, i % 2);
        if (quarter.suits_kernel()) {
            DrawBlocks({&quarter, 1}, out);
        } else {
            quarter.RenderPixels(no_data, out);
        }
    }
}

}  // namespace

/// Blocks are gathered some time before they are drawn, so that the drawing of one need not wait
/// for the gathering of the next. They are drawn to memory of their own: rows of a panorama often
/// lie a power of two apart and displace each other from the cache unless they are written in one
/// go.
struct PanoramaRenderer::Strip {
    int count = 0;
    std::array<PanoramaBlock, kMaxStrip> blocks;
    StripPicture picture;
};

PanoramaRenderer::Samplers PanoramaRenderer::SamplersOf(const ComposedMap& map,
                                                        const RigFrames& frames) const {
    Samplers samplers;
    for (int s = 0; s < map.cameras(); ++s) {
        const Unit unit = map.unit_of(s);
        const auto camera = static_cast<std::size_t>(map.camera_of(s));
        const float gain = gains_[unit][camera];
        samplers.push_back({frames[unit][camera], gain > 0.25F && gain < 4.0F ? gain : 1.0F});
    }
    return samplers;
}

void PanoramaRenderer::Render(const ComposedMap& map, const RigFrames& frames, NoData no_data,
                              const PanoramaPlanes& out, TaskRunner& runner) const {
    const Samplers cameras = SamplersOf(map, frames);
    const Scene scene{map, cameras, nullptr, no_data};
    runner.Run(map.block_rows(), [&](int row) { RenderRow(scene, out, row); });
}

void PanoramaRenderer::RenderBlended(const ComposedMap& map, const RigFrames& frames,
                                     const MultibandBlend& bands, const PanoramaPlanes& out,
                                     TaskRunner& runner) const {
    const Samplers cameras = SamplersOf(map, frames);
    const Scene scene{map, cameras, &bands, NoData::kPattern};
    runner.Run(map.block_rows(), [&](int row) { RenderRow(scene, out, row); });
}

void PanoramaRenderer::RenderRow(const Scene& scene, const PanoramaPlanes& out, int row) {
    const int block_px = scene.map.block_px();
    const int step = kStrip_px / block_px;
    Strip strip;
    for (int first = 0; first < scene.map.block_cols(); first += step) {
        GatherStrip(scene, row, first, strip);
        const std::span blocks(strip.blocks.data(), static_cast<std::size_t>(strip.count));
        DrawBlocks(blocks, strip.picture.planes());
        for (PanoramaBlock& block : blocks) {
            if (!block.suits_kernel()) RenderPixels(block, scene.no_data, strip.picture.planes());
        }
        strip.picture.CopyTo(out, first * block_px, row * block_px, block_px);
    }
}

void PanoramaRenderer::GatherStrip(const Scene& scene, int row, int first_col, Strip& strip) {
    const int block_px = scene.map.block_px();
    strip.count = std::min(kStrip_px / block_px, scene.map.block_cols() - first_col);
    const BlockSources sources(scene.map, row, first_col, strip.count);
    for (int i = 0; i < strip.count; ++i) {
        PanoramaBlock& block = strip.blocks[static_cast<std::size_t>(i)];
        block.x = i * block_px;
        block.side_px = block_px;
        block.phase_px = (first_col + i + row) * block_px;
        Gather(scene, row, first_col + i, sources.of(i), block);
        block.Prepare();
    }
}

/// `sources`: bit s is source s of the map.
void PanoramaRenderer::Gather(const Scene& scene, int row, int col, unsigned sources,
                              PanoramaBlock& block) {
    block.sources.clear();
    block.camera_missing = false;
    const bool shifts = scene.bands != nullptr && sources != 0 && scene.bands->Shifts(row, col);
    for (; sources != 0; sources &= sources - 1) {
        const int s = std::countr_zero(sources);
        const CameraSampler& camera = scene.cameras[static_cast<std::size_t>(s)];
        if (!camera.frame().present()) {
            block.camera_missing = true;
            continue;
        }
        BlockSource& source = block.sources.emplace_back();
        source.camera = &camera;
        ReadCorners(scene.map, s, row, col, source);
        if (source.LiesBeside()) {
            block.sources.pop_back();
            continue;
        }
        source.shifted = shifts && ShiftSource(*scene.bands, s, row, col, source);
    }
}

}  // namespace hitchview::algo
