#include "algo/panorama_renderer.hpp"

#include <algorithm>
#include <bit>

namespace hitchview::algo {
namespace {

/// Which sources of the map are seen in the blocks of a part of a block row; bit s is source s.
class BlockSources {
 public:
    static constexpr int kCols = 64;

    BlockSources(const ComposedMap& map, int row, int first_col, int cols) {
        for (int s = 0; s < map.cameras(); ++s) {
            const ComposedMap::Corner* upper = &map.corner(s, row, first_col);
            const ComposedMap::Corner* lower = &map.corner(s, row + 1, first_col);
            for (int i = 0; i <= cols; ++i) {
                const auto at = static_cast<std::size_t>(i);
                const bool used = upper[i].weight > 0 || lower[i].weight > 0;
                used_[at] |= static_cast<unsigned>(used) << s;
                seen_[at] |= static_cast<unsigned>(upper[i].sees && lower[i].sees) << s;
            }
        }
    }

    /// Of block `i` of the part: those with a share at one of its corners, and a place in the
    /// camera at all four.
    [[nodiscard]] unsigned of(int i) const {
        const auto at = static_cast<std::size_t>(i);
        return (used_[at] | used_[at + 1]) & seen_[at] & seen_[at + 1];
    }

 private:
    std::array<unsigned, kCols + 1> used_{};
    std::array<unsigned, kCols + 1> seen_{};
};

void PlaceSource(const ComposedMap& map, int s, int row, int col, BlockSource& source) {
    const ComposedMap::Corner* upper = &map.corner(s, row, col);
    const ComposedMap::Corner* lower = &map.corner(s, row + 1, col);
    source.x = {upper[0].x, upper[1].x, lower[0].x, lower[1].x};
    source.y = {upper[0].y, upper[1].y, lower[0].y, lower[1].y};
    source.weight = {upper[0].weight, upper[1].weight, lower[0].weight, lower[1].weight};
}

/// False, and nothing done, where the shift is too small to show.
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

}  // namespace

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
    runner.Run(map.block_rows(), [&](int row) { RenderBlockRow(scene, out, row); });
}

void PanoramaRenderer::RenderBlended(const ComposedMap& map, const RigFrames& frames,
                                     const MultibandBlend& bands, const PanoramaPlanes& out,
                                     TaskRunner& runner) const {
    const Samplers cameras = SamplersOf(map, frames);
    const Scene scene{map, cameras, &bands, NoData::kPattern};
    runner.Run(map.block_rows(), [&](int row) { RenderBlockRow(scene, out, row); });
}

void PanoramaRenderer::RenderBlockRow(const Scene& scene, const PanoramaPlanes& out, int row) {
    constexpr int kBlock = ComposedMap::kBlock;
    PanoramaBlock block;
    block.y = row * kBlock;
    block.height = std::min(kBlock, out.height_px - block.y);
    const int cols = scene.map.block_cols();
    for (int first = 0; first < cols; first += BlockSources::kCols) {
        const int count = std::min(BlockSources::kCols, cols - first);
        const BlockSources sources(scene.map, row, first, count);
        for (int i = 0; i < count; ++i) {
            block.x = (first + i) * kBlock;
            block.width = std::min(kBlock, out.width_px - block.x);
            Gather(scene, row, first + i, sources.of(i), block);
            block.Render(scene.no_data, out);
        }
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
        PlaceSource(scene.map, s, row, col, source);
        source.shifted = shifts && ShiftSource(*scene.bands, s, row, col, source);
    }
}

}  // namespace hitchview::algo
