#include "algo/panorama_renderer.hpp"

#include <algorithm>
#include <cmath>

#include "algo/fixed_vector.hpp"

namespace hitchview::algo {
namespace {

constexpr int kBlock = ComposedMap::kBlock;
constexpr int kChromaBlock = kBlock / 2;
constexpr int kFixed = 8;  // bits of a pixel coordinate's fraction
constexpr int kOne = 1 << kFixed;
constexpr std::uint8_t kBlackLuma = 0;
constexpr std::uint8_t kNeutral = 128;

/// Camera coordinates over one block, from its four corners.
struct Patch {
    std::array<float, 4> x;  // top left, top right, bottom left, bottom right
    std::array<float, 4> y;
    std::array<float, 4> weight;
};

/// Values at the `cells` sample points of one row of a block, n samples to a side.
template <int kN>
void InterpolateRow(const std::array<float, 4>& corner, int row, std::array<float, kN>& values) {
    const float v = (static_cast<float>(row) + 0.5F) / kN;
    const float left = corner[0] + v * (corner[2] - corner[0]);
    const float right = corner[1] + v * (corner[3] - corner[1]);
    const float step = (right - left) / kN;
    for (int i = 0; i < kN; ++i) {
        values[static_cast<std::size_t>(i)] = left + step * (static_cast<float>(i) + 0.5F);
    }
}

struct FixedPoint {
    int whole;
    int fraction;  // 0..kOne
};

/// Splits a coordinate so that whole and whole + 1 lie in 0..last, whatever the coordinate.
FixedPoint Split(float value, int last) {
    const int fixed = std::clamp(static_cast<int>(value * kOne + 0.5F), 0, last << kFixed);
    const int whole = std::min(fixed >> kFixed, last - 1);
    return {whole, fixed - (whole << kFixed)};
}

/// Bilinear sample; kStep bytes from one sample to the next.
template <int kStep>
int ReadBilinear(const std::uint8_t* plane, int stride, const FixedPoint& x, const FixedPoint& y) {
    const std::uint8_t* a = plane + static_cast<std::ptrdiff_t>(y.whole) * stride + x.whole * kStep;
    const std::uint8_t* b = a + stride;
    const int top = a[0] * (kOne - x.fraction) + a[kStep] * x.fraction;
    const int bottom = b[0] * (kOne - x.fraction) + b[kStep] * x.fraction;
    return (top * (kOne - y.fraction) + bottom * y.fraction + (1 << (2 * kFixed - 1))) >>
           (2 * kFixed);
}

float ToChroma(float luma_coordinate) {
    return 0.5F * luma_coordinate - 0.25F;
}

std::uint8_t Round(float value) {
    return static_cast<std::uint8_t>(value + 0.5F);
}

/// What is added to a source's luma, u and v over one block.
struct Shift {
    std::array<std::array<float, 4>, 3> of;  // by channel, corners as in Patch

    /// Too small to show.
    [[nodiscard]] bool IsNothing() const {
        constexpr float kLeast = 0.25F;
        for (const auto& channel : of) {
            for (const float value : channel) {
                if (std::abs(value) > kLeast) return false;
            }
        }
        return true;
    }
};

Shift ShiftOf(const MultibandBlend& bands, int source, int row, int col) {
    Shift shift{};
    if (!bands.Shifts(row, col)) return shift;
    for (std::size_t k = 0; k < 4; ++k) {
        const MultibandBlend::Colour colour =
            bands.shift(source, row + static_cast<int>(k / 2), col + static_cast<int>(k % 2));
        for (std::size_t channel = 0; channel < 3; ++channel)
            shift.of[channel][k] = colour[static_cast<int>(channel)];
    }
    return shift;
}

std::uint8_t RoundMean(float sum, float weight) {
    return Round(std::clamp(sum / weight, 0.0F, 255.0F));
}

std::uint8_t RoundShifted(std::uint8_t value, float shift) {
    return Round(std::clamp(static_cast<float>(value) + shift, 0.0F, 255.0F));
}

}  // namespace

struct PanoramaRenderer::BlockSource {
    const CameraFrame* frame;
    const CameraLut* lut;
    Patch patch;
    Shift shift;

    [[nodiscard]] bool Sees(float x, float y) const {
        return x >= 0 && y >= 0 && x <= static_cast<float>(frame->width_px - 1) &&
               y <= static_cast<float>(frame->height_px - 1);
    }
    /// The whole block lies inside the camera's picture: its four corners do.
    [[nodiscard]] bool SeesAll() const {
        return Sees(patch.x[0], patch.y[0]) && Sees(patch.x[1], patch.y[1]) &&
               Sees(patch.x[2], patch.y[2]) && Sees(patch.x[3], patch.y[3]);
    }
    [[nodiscard]] std::uint8_t Luma(float x, float y) const {
        return lut->luma[static_cast<std::size_t>(
            ReadBilinear<1>(frame->luma, frame->luma_stride_bytes, Split(x, frame->width_px - 1),
                            Split(y, frame->height_px - 1)))];
    }
    void Chroma(float x, float y, std::uint8_t& u, std::uint8_t& v) const {
        const FixedPoint fx = Split(ToChroma(x), frame->width_px / 2 - 1);
        const FixedPoint fy = Split(ToChroma(y), frame->height_px / 2 - 1);
        const int stride = frame->chroma_stride_bytes;
        u = lut->chroma[static_cast<std::size_t>(ReadBilinear<2>(frame->chroma, stride, fx, fy))];
        v = lut->chroma[static_cast<std::size_t>(
            ReadBilinear<2>(frame->chroma + 1, stride, fx, fy))];
    }
};

struct PanoramaRenderer::Block {
    FixedVector<BlockSource, kMaxCameras> sources;
    bool camera_missing = false;
    int x = 0;  // top left canvas pixel
    int y = 0;
    int width = kBlock;  // less at the right and lower edge of the canvas
    int height = kBlock;

    [[nodiscard]] std::uint8_t EmptyLuma(NoData no_data, int at_x, int at_y) const {
        constexpr std::uint8_t kDark = 40;
        constexpr std::uint8_t kLight = 72;
        if (no_data == NoData::kBlack || !camera_missing) return kBlackLuma;
        return (((at_x + at_y) >> 3) & 1) != 0 ? kLight : kDark;
    }

    template <bool kShifted>
    void CopyLuma(const PanoramaPlanes& out) const {
        const BlockSource& source = sources[0];
        std::array<float, kBlock> xs;
        std::array<float, kBlock> ys;
        std::array<float, kBlock> shifts{};
        for (int r = 0; r < height; ++r) {
            InterpolateRow<kBlock>(source.patch.x, r, xs);
            InterpolateRow<kBlock>(source.patch.y, r, ys);
            if constexpr (kShifted) InterpolateRow<kBlock>(source.shift.of[0], r, shifts);
            std::uint8_t* to = out.y + static_cast<std::ptrdiff_t>(y + r) * out.y_stride_bytes + x;
            for (int c = 0; c < width; ++c) {
                const auto i = static_cast<std::size_t>(c);
                const std::uint8_t luma = source.Luma(xs[i], ys[i]);
                to[c] = kShifted ? RoundShifted(luma, shifts[i]) : luma;
            }
        }
    }

    template <bool kShifted>
    void CopyChroma(const PanoramaPlanes& out) const {
        const BlockSource& source = sources[0];
        std::array<float, kChromaBlock> xs;
        std::array<float, kChromaBlock> ys;
        std::array<float, kChromaBlock> us{};
        std::array<float, kChromaBlock> vs{};
        for (int r = 0; r < height / 2; ++r) {
            InterpolateRow<kChromaBlock>(source.patch.x, r, xs);
            InterpolateRow<kChromaBlock>(source.patch.y, r, ys);
            if constexpr (kShifted) {
                InterpolateRow<kChromaBlock>(source.shift.of[1], r, us);
                InterpolateRow<kChromaBlock>(source.shift.of[2], r, vs);
            }
            const auto to =
                static_cast<std::ptrdiff_t>(y / 2 + r) * out.chroma_stride_bytes + x / 2;
            for (int c = 0; c < width / 2; ++c) {
                const auto i = static_cast<std::size_t>(c);
                source.Chroma(xs[i], ys[i], out.u[to + c], out.v[to + c]);
                if constexpr (kShifted) {
                    out.u[to + c] = RoundShifted(out.u[to + c], us[i]);
                    out.v[to + c] = RoundShifted(out.v[to + c], vs[i]);
                }
            }
        }
    }

    void BlendLuma(NoData no_data, const PanoramaPlanes& out) const {
        std::array<float, kBlock> xs;
        std::array<float, kBlock> ys;
        std::array<float, kBlock> ws;
        std::array<float, kBlock> shifts;
        for (int r = 0; r < height; ++r) {
            std::array<float, kBlock> sum{};
            std::array<float, kBlock> weight{};
            for (const BlockSource& source : sources) {
                InterpolateRow<kBlock>(source.patch.x, r, xs);
                InterpolateRow<kBlock>(source.patch.y, r, ys);
                InterpolateRow<kBlock>(source.patch.weight, r, ws);
                InterpolateRow<kBlock>(source.shift.of[0], r, shifts);
                for (std::size_t i = 0; i < kBlock; ++i) {
                    if (ws[i] <= 0 || !source.Sees(xs[i], ys[i])) continue;
                    sum[i] += ws[i] * (static_cast<float>(source.Luma(xs[i], ys[i])) + shifts[i]);
                    weight[i] += ws[i];
                }
            }
            std::uint8_t* to = out.y + static_cast<std::ptrdiff_t>(y + r) * out.y_stride_bytes + x;
            for (int c = 0; c < width; ++c) {
                const auto i = static_cast<std::size_t>(c);
                to[c] =
                    weight[i] > 0 ? RoundMean(sum[i], weight[i]) : EmptyLuma(no_data, x + c, y + r);
            }
        }
    }

    void BlendChroma(const PanoramaPlanes& out) const {
        std::array<float, kChromaBlock> xs;
        std::array<float, kChromaBlock> ys;
        std::array<float, kChromaBlock> ws;
        std::array<float, kChromaBlock> us;
        std::array<float, kChromaBlock> vs;
        for (int r = 0; r < height / 2; ++r) {
            std::array<float, kChromaBlock> sum_u{};
            std::array<float, kChromaBlock> sum_v{};
            std::array<float, kChromaBlock> weight{};
            for (const BlockSource& source : sources) {
                InterpolateRow<kChromaBlock>(source.patch.x, r, xs);
                InterpolateRow<kChromaBlock>(source.patch.y, r, ys);
                InterpolateRow<kChromaBlock>(source.patch.weight, r, ws);
                InterpolateRow<kChromaBlock>(source.shift.of[1], r, us);
                InterpolateRow<kChromaBlock>(source.shift.of[2], r, vs);
                for (std::size_t i = 0; i < kChromaBlock; ++i) {
                    if (ws[i] <= 0 || !source.Sees(xs[i], ys[i])) continue;
                    std::uint8_t u;
                    std::uint8_t v;
                    source.Chroma(xs[i], ys[i], u, v);
                    sum_u[i] += ws[i] * (static_cast<float>(u) + us[i]);
                    sum_v[i] += ws[i] * (static_cast<float>(v) + vs[i]);
                    weight[i] += ws[i];
                }
            }
            const auto to =
                static_cast<std::ptrdiff_t>(y / 2 + r) * out.chroma_stride_bytes + x / 2;
            for (int c = 0; c < width / 2; ++c) {
                const auto i = static_cast<std::size_t>(c);
                out.u[to + c] = weight[i] > 0 ? RoundMean(sum_u[i], weight[i]) : kNeutral;
                out.v[to + c] = weight[i] > 0 ? RoundMean(sum_v[i], weight[i]) : kNeutral;
            }
        }
    }
};

void PanoramaRenderer::SetGains(const CameraGains& gains) {
    for (const Unit unit : kUnits) {
        for (std::size_t i = 0; i < kMaxCameras; ++i) {
            const float given = gains[unit][i];
            const float gain = given > 0.25F && given < 4.0F ? given : 1.0F;
            for (int value = 0; value < 256; ++value) {
                const auto at = static_cast<std::size_t>(value);
                const auto luma = gain * static_cast<float>(value);
                const auto chroma = 128 + gain * static_cast<float>(value - 128);
                luts_[unit][i].luma[at] = Round(std::min(255.0F, luma));
                luts_[unit][i].chroma[at] = Round(std::clamp(chroma, 0.0F, 255.0F));
            }
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

/// True if the block is no more than one camera's.
bool PanoramaRenderer::Gather(const Scene& scene, int row, int col, Block& block) const {
    const ComposedMap& map = scene.map;
    block.sources.clear();
    block.camera_missing = false;
    for (int s = 0; s < map.cameras(); ++s) {
        const std::array<const ComposedMap::Corner*, 4> corners{
            &map.corner(s, row, col), &map.corner(s, row, col + 1), &map.corner(s, row + 1, col),
            &map.corner(s, row + 1, col + 1)};
        bool used = false;
        bool sees = true;
        BlockSource source{};
        for (std::size_t k = 0; k < corners.size(); ++k) {
            used = used || corners[k]->weight > 0;
            sees = sees && corners[k]->sees;
            source.patch.x[k] = corners[k]->x;
            source.patch.y[k] = corners[k]->y;
            source.patch.weight[k] = corners[k]->weight;
        }
        if (!used || !sees) continue;
        const auto camera = static_cast<std::size_t>(map.camera_of(s));
        source.frame = &scene.frames[map.unit_of(s)][camera];
        source.lut = &luts_[map.unit_of(s)][camera];
        if (!source.frame->present()) {
            block.camera_missing = true;
            continue;
        }
        if (scene.bands != nullptr) source.shift = ShiftOf(*scene.bands, s, row, col);
        block.sources.push_back(source);
    }
    return block.sources.size() == 1 && !block.camera_missing && block.sources[0].SeesAll();
}

void PanoramaRenderer::RenderBlockRow(const Scene& scene, const PanoramaPlanes& out,
                                      int row) const {
    Block block;
    block.y = row * kBlock;
    block.height = std::min(kBlock, out.height_px - block.y);
    for (int col = 0; col < scene.map.block_cols(); ++col) {
        block.x = col * kBlock;
        block.width = std::min(kBlock, out.width_px - block.x);
        if (!Gather(scene, row, col, block)) {
            block.BlendLuma(scene.no_data, out);
            block.BlendChroma(out);
        } else if (block.sources[0].shift.IsNothing()) {
            block.CopyLuma<false>(out);
            block.CopyChroma<false>(out);
        } else {
            block.CopyLuma<true>(out);
            block.CopyChroma<true>(out);
        }
    }
}

}  // namespace hitchview::algo
