#include "algo/panorama_renderer.hpp"

#include <algorithm>

namespace hitchview::algo {
namespace {

std::uint8_t Round(float value) {
    return static_cast<std::uint8_t>(value + 0.5F);
}

CameraLut LutOf(float gain) {
    CameraLut lut;
    for (int value = 0; value < 256; ++value) {
        const auto at = static_cast<std::size_t>(value);
        const auto luma = gain * static_cast<float>(value);
        const auto chroma = 128 + gain * static_cast<float>(value - 128);
        lut.luma[at] = Round(std::min(255.0F, luma));
        lut.chroma[at] = Round(std::clamp(chroma, 0.0F, 255.0F));
    }
    return lut;
}

/// Where a source of the map is read over one block. False if it has no share there, or does not
/// see all of it.
bool PlaceSource(const ComposedMap& map, int s, int row, int col, BlockSource& source) {
    const std::array<const ComposedMap::Corner*, 4> corners{
        &map.corner(s, row, col), &map.corner(s, row, col + 1), &map.corner(s, row + 1, col),
        &map.corner(s, row + 1, col + 1)};
    bool used = false;
    bool sees = true;
    for (std::size_t k = 0; k < corners.size(); ++k) {
        used = used || corners[k]->weight > 0;
        sees = sees && corners[k]->sees;
        source.x[k] = corners[k]->x;
        source.y[k] = corners[k]->y;
        source.weight[k] = corners[k]->weight;
    }
    return used && sees;
}

void ShiftSource(const MultibandBlend& bands, int s, int row, int col, BlockSource& source) {
    if (!bands.Shifts(row, col)) return;
    for (std::size_t k = 0; k < 4; ++k) {
        const MultibandBlend::Colour colour =
            bands.shift(s, row + static_cast<int>(k / 2), col + static_cast<int>(k % 2));
        for (std::size_t channel = 0; channel < 3; ++channel)
            source.shift[channel][k] = colour[static_cast<int>(channel)];
    }
}

}  // namespace

void PanoramaRenderer::SetGains(const CameraGains& gains) {
    for (const Unit unit : kUnits) {
        for (std::size_t i = 0; i < kMaxCameras; ++i) {
            const float given = gains[unit][i];
            luts_[unit][i] = LutOf(given > 0.25F && given < 4.0F ? given : 1.0F);
        }
    }
}

void PanoramaRenderer::Render(const ComposedMap& map, const RigFrames& frames, NoData no_data,
                              const PanoramaPlanes& out, TaskRunner& runner) const {
    const Scene scene{map, frames, nullptr, no_data};
    runner.Run(map.block_rows(), [&](int row) { RenderBlockRow(scene, out, row); });
}

void PanoramaRenderer::RenderBlended(const ComposedMap& map, const RigFrames& frames,
                                     const MultibandBlend& bands, const PanoramaPlanes& out,
                                     TaskRunner& runner) const {
    const Scene scene{map, frames, &bands, NoData::kPattern};
    runner.Run(map.block_rows(), [&](int row) { RenderBlockRow(scene, out, row); });
}

void PanoramaRenderer::Gather(const Scene& scene, int row, int col, PanoramaBlock& block) const {
    block.sources.clear();
    block.camera_missing = false;
    for (int s = 0; s < scene.map.cameras(); ++s) {
        BlockSource source{};
        if (!PlaceSource(scene.map, s, row, col, source)) continue;
        const Unit unit = scene.map.unit_of(s);
        const auto camera = static_cast<std::size_t>(scene.map.camera_of(s));
        const CameraFrame& frame = scene.frames[unit][camera];
        if (!frame.present()) {
            block.camera_missing = true;
            continue;
        }
        source.camera = {frame, luts_[unit][camera]};
        if (scene.bands != nullptr) ShiftSource(*scene.bands, s, row, col, source);
        block.sources.push_back(source);
    }
}

void PanoramaRenderer::RenderBlockRow(const Scene& scene, const PanoramaPlanes& out,
                                      int row) const {
    constexpr int kBlock = ComposedMap::kBlock;
    PanoramaBlock block;
    block.y = row * kBlock;
    block.height = std::min(kBlock, out.height_px - block.y);
    for (int col = 0; col < scene.map.block_cols(); ++col) {
        block.x = col * kBlock;
        block.width = std::min(kBlock, out.width_px - block.x);
        Gather(scene, row, col, block);
        block.Render(scene.no_data, out);
    }
}

}  // namespace hitchview::algo
