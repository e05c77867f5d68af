#include "algo/block_kernel.hpp"

#include <algorithm>
#include <cmath>
#include <cstring>

#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "algo/block_kernel.cpp"
#include <hwy/foreach_target.h>
#include <hwy/highway.h>

#include "algo/block_kernel-inl.hpp"

HWY_BEFORE_NAMESPACE();
namespace hitchview::algo::HWY_NAMESPACE {

#if HWY_TARGET == HWY_SCALAR

bool PlaceSourceHere(BlockSource& /*source*/) {
    return false;
}
void DrawBlocksHere(std::span<const PanoramaBlock> /*blocks*/, const PanoramaPlanes& /*out*/) {}

#else

/// 8.7 samples to levels: full range, times the camera's gain, clamped.
HWY_INLINE V16 LumaLevels(const CameraSampler::Tone& tone, VU16 samples) {
    const D16 d;
    const DU16 du;
    const VU16 bright = hn::SaturatedSub(samples, hn::Set(du, tone.luma_black));
    const VU16 shown = hn::MulHigh(hn::ShiftLeft<1>(bright), hn::Set(du, tone.luma_factor));
    constexpr int kBits = kSampleBits + 1 + 13 - 16;
    const VU16 most = hn::Set(du, std::uint16_t{255 << kBits});
    return hn::BitCast(d, hn::ShiftLeft<kLevelBits - kBits>(hn::Min(shown, most)));
}

HWY_INLINE V16 ChromaLevels(const CameraSampler::Tone& tone, VU16 samples) {
    const D16 d;
    const V16 from_grey =
        hn::Sub(hn::BitCast(d, samples), hn::Set(d, std::int16_t{128 << kSampleBits}));
    const V16 shown = hn::MulHigh(hn::ShiftLeft<1>(from_grey), hn::Set(d, tone.chroma_factor));
    constexpr int kBits = kSampleBits + 1 + 12 - 16;
    const V16 least = hn::Set(d, std::int16_t{-(128 << kBits)});
    const V16 most = hn::Set(d, std::int16_t{127 << kBits});
    const V16 clamped = hn::Min(hn::Max(shown, least), most);
    return hn::Add(hn::ShiftLeft<kLevelBits - kBits>(clamped),
                   hn::Set(d, std::int16_t{128 << kLevelBits}));
}

/// A channel's rows of a block; between the corners everything is linear.
struct Line {
    std::int16_t first[kBlockLanes];
    std::int16_t step[kBlockLanes];
};

/// Rows of values given at the corners, `one` to a unit.
template <int kSide>
HWY_INLINE Line LineOf(const Corners& corners, float one) {
    Line line;
    constexpr float kHalf = 0.5F / kSide;
    for (int r = 0; r < kSide; ++r) {
        const float v = (static_cast<float>(r) + 0.5F) / kSide;
        const float left = corners[0] + v * (corners[2] - corners[0]);
        const float right = corners[1] + v * (corners[3] - corners[1]);
        line.first[r] =
            static_cast<std::int16_t>(std::lrint(one * (left + kHalf * (right - left))));
        line.step[r] = static_cast<std::int16_t>(std::lrint(one * (right - left) / kSide));
    }
    return line;
}

/// One kind of samples of one block.
template <typename Kind>
class Drawing {
 public:
    explicit Drawing(const PanoramaBlock& block) : block_(block) {}

    void Draw(const PanoramaPlanes& out) {
        if (block_.sources.size() > 1) {
            BlendLevels();
            Finish<kLevelBits - 1>(sum_);
        } else if (block_.sources[0].shifted) {
            ReadLevels(block_.sources[0]);
            Finish<kLevelBits>(levels_);
        } else {
            DrawPlain(block_.sources[0]);
        }
        Kind::Write(block_, bytes_, out);
    }

 private:
    static constexpr std::size_t kLanes = Kind::kSide * kBlockLanes;

    static V16 LevelsOf(const CameraSampler::Tone& tone, VU16 samples) {
        const D16 d;
        return tone.as_taken ? hn::BitCast(d, hn::ShiftRight<kSampleBits - kLevelBits>(samples))
                             : Kind::Levels(tone, samples);
    }

    void DrawPlain(const BlockSource& source) {
        const DU16 du;
        Kind::Read(source, samples_);
        for (std::size_t i = 0; i < kLanes; i += hn::Lanes(du)) {
            const V16 levels = LevelsOf(source.camera->tone(), hn::Load(du, samples_ + i));
            StoreRounded<kLevelBits>(levels, bytes_ + i);
        }
    }

    HWY_NOINLINE void ReadLevels(const BlockSource& source) {
        const D16 d;
        const DU16 du;
        Kind::Read(source, samples_);
        for (std::size_t i = 0; i < kLanes; i += hn::Lanes(d))
            hn::Store(LevelsOf(source.camera->tone(), hn::Load(du, samples_ + i)), d, levels_ + i);
        if (source.shifted) AddShift(source);
    }

    void AddShift(const BlockSource& source) {
        const D16 d;
        constexpr float kMost = 255;
        Line lines[Kind::kChannels];
        for (std::size_t k = 0; k < Kind::kChannels; ++k) {
            Corners corners = source.shift[Kind::kFirstShift + k];
            for (float& value : corners) value = std::clamp(value, -kMost, kMost);
            lines[k] = LineOf<Kind::kSide>(corners, 1 << kLevelBits);
        }
        Spread(lines);
        for (std::size_t i = 0; i < kLanes; i += hn::Lanes(d)) {
            const V16 sum = hn::SaturatedAdd(hn::Load(d, levels_ + i), hn::Load(d, spread_ + i));
            hn::Store(sum, d, levels_ + i);
        }
    }

    void BlendLevels() {
        const D16 d;
        for (std::size_t i = 0; i < kLanes; i += hn::Lanes(d)) hn::Store(hn::Zero(d), d, sum_ + i);
        for (const BlockSource& source : block_.sources) {
            ReadLevels(source);
            // A little less than 1 << 15: rounded steps must not lead beyond the largest value.
            constexpr float kWhole = (1 << 15) - 16;
            Line lines[Kind::kChannels];
            for (Line& line : lines) line = LineOf<Kind::kSide>(source.weight, kWhole);
            Spread(lines);
            for (std::size_t i = 0; i < kLanes; i += hn::Lanes(d)) {
                const V16 part = hn::MulHigh(hn::Load(d, levels_ + i), hn::Load(d, spread_ + i));
                hn::Store(hn::SaturatedAdd(hn::Load(d, sum_ + i), part), d, sum_ + i);
            }
        }
    }

    /// Linear along the rows, to the lanes.
    void Spread(const Line (&lines)[Kind::kChannels]) {
        for (int r = 0; r < Kind::kSide; ++r) {
            for (std::size_t k = 0; k < Kind::kChannels; ++k) {
                std::int16_t* to = spread_ + r * kBlockLanes + static_cast<int>(k) * Kind::kSide;
                for (int i = 0; i < Kind::kSide; ++i)
                    to[i] = static_cast<std::int16_t>(lines[k].first[r] + i * lines[k].step[r]);
            }
        }
    }

    /// `kBits` fractional bits.
    template <int kBits>
    static void StoreRounded(V16 levels, std::uint8_t* to) {
        const D16 d;
        const hn::Rebind<std::uint8_t, D16> d8;
        const V16 half = hn::Set(d, std::int16_t{1 << (kBits - 1)});
        const V16 rounded = hn::ShiftRight<kBits>(hn::SaturatedAdd(levels, half));
        hn::Store(hn::DemoteTo(d8, rounded), d8, to);
    }

    template <int kBits>
    void Finish(const std::int16_t* levels) {
        const D16 d;
        for (std::size_t i = 0; i < kLanes; i += hn::Lanes(d))
            StoreRounded<kBits>(hn::Load(d, levels + i), bytes_ + i);
    }

    const PanoramaBlock& block_;
    HWY_ALIGN std::uint16_t samples_[kLanes];
    HWY_ALIGN std::int16_t levels_[kLanes];
    HWY_ALIGN std::int16_t sum_[kLanes];
    HWY_ALIGN std::int16_t spread_[kLanes];
    HWY_ALIGN std::uint8_t bytes_[kLanes];
};

/// Rows of `kBytes`, `from_stride_bytes` apart.
template <int kBytes>
HWY_INLINE void WriteRows(const std::uint8_t* from, int bytes, int rows, std::uint8_t* to,
                          int stride_bytes) {
    for (int r = 0; r < rows; ++r) {
        const std::uint8_t* row = from + r * kBlockLanes;
        std::uint8_t* out = to + static_cast<std::ptrdiff_t>(r) * stride_bytes;
        if (bytes == kBytes) {
            std::memcpy(out, row, kBytes);
        } else {
            std::memcpy(out, row, static_cast<std::size_t>(bytes));
        }
    }
}

struct LumaKind {
    static constexpr int kSide = 8;
    static constexpr std::size_t kChannels = 1;
    static constexpr std::size_t kFirstShift = 0;

    static void Read(const BlockSource& source, std::uint16_t* samples) {
        ReadLuma(source, samples);
    }
    static V16 Levels(const CameraSampler::Tone& tone, VU16 samples) {
        return LumaLevels(tone, samples);
    }
    static void Write(const PanoramaBlock& block, const std::uint8_t* bytes,
                      const PanoramaPlanes& out) {
        const auto at = static_cast<std::ptrdiff_t>(block.y) * out.y_stride_bytes + block.x;
        WriteRows<8>(bytes, block.width, block.height, out.y + at, out.y_stride_bytes);
    }
};

struct ChromaKind {
    static constexpr int kSide = 4;
    static constexpr std::size_t kChannels = 2;
    static constexpr std::size_t kFirstShift = 1;

    static void Read(const BlockSource& source, std::uint16_t* samples) {
        ReadChroma(source, samples);
    }
    static V16 Levels(const CameraSampler::Tone& tone, VU16 samples) {
        return ChromaLevels(tone, samples);
    }
    static void Write(const PanoramaBlock& block, const std::uint8_t* bytes,
                      const PanoramaPlanes& out) {
        const int stride_bytes = out.chroma_stride_bytes;
        const auto at = static_cast<std::ptrdiff_t>(block.y / 2) * stride_bytes + block.x / 2;
        const int cols = block.width / 2;
        const int rows = block.height / 2;
        WriteRows<4>(bytes, cols, rows, out.u + at, stride_bytes);
        WriteRows<4>(bytes + 4, cols, rows, out.v + at, stride_bytes);
    }
};

bool PlaceSourceHere(BlockSource& source) {
    const CameraFrame& frame = source.camera->frame();
    PlaceWindows<8>(source.x, source.y, frame.width_px, frame.height_px, source.luma);
    if (!frame.has_chroma()) return true;
    Corners x;
    Corners y;
    for (std::size_t k = 0; k < x.size(); ++k) {
        x[k] = CameraFrame::ChromaX(source.x[k]);
        y[k] = frame.ChromaY(source.y[k]);
    }
    const SamplePlane plane = frame.ChromaSamples(0);
    PlaceWindows<4>(x, y, plane.cols, plane.rows, source.chroma);
    return true;
}

template <typename Kind>
void DrawSamples(std::span<const PanoramaBlock> blocks, const PanoramaPlanes& out) {
    for (const PanoramaBlock& block : blocks) {
        if (block.suits_kernel()) Drawing<Kind>(block).Draw(out);
    }
}

void DrawBlocksHere(std::span<const PanoramaBlock> blocks, const PanoramaPlanes& out) {
    DrawSamples<LumaKind>(blocks, out);
    DrawSamples<ChromaKind>(blocks, out);
}

#endif  // HWY_TARGET == HWY_SCALAR

}  // namespace hitchview::algo::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace hitchview::algo {
namespace {
HWY_EXPORT(PlaceSourceHere);
HWY_EXPORT(DrawBlocksHere);
}  // namespace

bool PlaceSource(BlockSource& source) {
    return HWY_DYNAMIC_DISPATCH(PlaceSourceHere)(source);
}

void DrawBlocks(std::span<const PanoramaBlock> blocks, const PanoramaPlanes& out) {
    HWY_DYNAMIC_DISPATCH(DrawBlocksHere)(blocks, out);
}

}  // namespace hitchview::algo
#endif
