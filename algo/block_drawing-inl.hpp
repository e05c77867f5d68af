// Compiled once for each instruction set, from block_kernel.cpp.
#if defined(HITCHVIEW_ALGO_BLOCK_DRAWING_INL_HPP_) == defined(HWY_TARGET_TOGGLE)
#ifdef HITCHVIEW_ALGO_BLOCK_DRAWING_INL_HPP_
#undef HITCHVIEW_ALGO_BLOCK_DRAWING_INL_HPP_
#else
#define HITCHVIEW_ALGO_BLOCK_DRAWING_INL_HPP_
#endif

#include <hwy/highway.h>

#include <algorithm>
#include <cstring>

#include "algo/segment_samples-inl.hpp"

HWY_BEFORE_NAMESPACE();
namespace hitchview::algo::HWY_NAMESPACE {

#if HWY_TARGET != HWY_SCALAR

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

/// `kBits` fractional bits.
template <int kBits>
HWY_INLINE void StoreRounded(V16 levels, std::uint8_t* to) {
    const D16 d;
    const hn::Rebind<std::uint8_t, D16> d8;
    const V16 half = hn::Set(d, std::int16_t{1 << (kBits - 1)});
    const V16 rounded = hn::ShiftRight<kBits>(hn::SaturatedAdd(levels, half));
    hn::Store(hn::DemoteTo(d8, rounded), d8, to);
}

/// Rows of `kBytes` without a gap, to rows that lie `stride_bytes` apart.
template <int kBytes>
HWY_INLINE void WriteRows(const std::uint8_t* from, int rows, std::uint8_t* to, int stride_bytes) {
    for (int r = 0; r < rows; ++r) {
        std::memcpy(to, from, kBytes);
        from += kBytes;
        to += stride_bytes;
    }
}

struct LumaKind {
    static constexpr int kSamples = 8;  // to a segment
    static constexpr std::size_t kChannels = 1;
    static constexpr std::size_t kFirstShift = 0;
    static constexpr int kLogPackedStep = 1;
    static constexpr std::uint8_t kEmpty = 0;

    static Samples Plane(const CameraFrame& frame) { return LumaOf(frame); }
    static const SampleWindows& Windows(const BlockSource& source) { return source.luma; }
    static V16 Levels(const CameraSampler::Tone& tone, VU16 samples) {
        return LumaLevels(tone, samples);
    }
    static V16 Shift(const SegmentLines (&shift)[kChannels], int s) {
        return hn::BitCast(D16(), Along<kSamples>(shift[0], s));
    }
    template <int kParts>
    static void Write(const PanoramaBlock& block, const std::uint8_t* bytes,
                      const PanoramaPlanes& out) {
        const auto at = static_cast<std::ptrdiff_t>(block.y) * out.y_stride_bytes + block.x;
        constexpr int kSide = kParts * kSamples;
        WriteRows<kSide>(bytes, kSide, out.y + at, out.y_stride_bytes);
    }
};

struct ChromaKind {
    static constexpr int kSamples = 4;
    static constexpr std::size_t kChannels = 2;
    static constexpr std::size_t kFirstShift = 1;
    static constexpr int kLogPackedStep = 2;
    static constexpr std::uint8_t kEmpty = 128;

    static Samples Plane(const CameraFrame& frame) { return ChromaOf(frame); }
    static const SampleWindows& Windows(const BlockSource& source) { return source.chroma; }
    static V16 Levels(const CameraSampler::Tone& tone, VU16 samples) {
        return ChromaLevels(tone, samples);
    }
    static V16 Shift(const SegmentLines (&shift)[kChannels], int s) {
        const DU16 du;
        const VU16 second = hn::Load(du, kLaneTable<kSamples>.second);
        return hn::BitCast(D16(), hn::Or(hn::AndNot(second, Along<kSamples>(shift[0], s)),
                                         hn::And(second, Along<kSamples>(shift[1], s))));
    }
    template <int kParts>
    static void Write(const PanoramaBlock& block, const std::uint8_t* bytes,
                      const PanoramaPlanes& out) {
        const int stride_bytes = out.chroma_stride_bytes;
        std::ptrdiff_t at = static_cast<std::ptrdiff_t>(block.y / 2) * stride_bytes + block.x / 2;
        for (int r = 0; r < kParts * kSamples; ++r) {
            for (int part = 0; part < kParts; ++part) {
                std::memcpy(out.u + at + part * kSamples, bytes, kSamples);
                std::memcpy(out.v + at + part * kSamples, bytes + kSamples, kSamples);
                bytes += kSegmentLanes;
            }
            at += stride_bytes;
        }
    }
};

/// One kind of samples of one block.
template <typename Kind, int kParts>
class Drawing {
 public:
    Drawing(const PanoramaBlock& block, const PanoramaPlanes& out) : block_(block) {
        if (block.sources.size() == 1) {
            Read<Part::kWhole>(block.sources[0]);
        } else {
            Blend();
        }
        if (block.on_edge()) ClearUnseen();
        Kind::template Write<kParts>(block, bytes_, out);
    }

 private:
    static constexpr int kSegments = SegmentTable<Kind::kSamples, kParts>::kSegments;
    static constexpr int kLanes = kSegments * kSegmentLanes;
    static constexpr int kNoColour = -1;
    /// A little less than 1 << 15: rounded steps must not lead beyond the largest value.
    static constexpr float kWholeShare = (1 << 15) - 16;
    /// Of a source in the block.
    enum class Part { kWhole, kFirst, kAnother };

    void Blend() {
        if (block_.on_edge()) SumWeights();
        for (std::size_t i = 0; i < block_.sources.size(); ++i) {
            const BlockSource& source = block_.sources[i];
            if (block_.on_edge()) {
                FindEdgeShares(source);
            } else {
                FindShares(source);
            }
            if (i == 0) {
                Read<Part::kFirst>(source);
            } else {
                Read<Part::kAnother>(source);
            }
        }
        for (int at = 0; at < kLanes; at += static_cast<int>(hn::Lanes(D16())))
            StoreRounded<kLevelBits - 1>(hn::Load(D16(), sum_ + at), bytes_ + at);
    }

    void FindShares(const BlockSource& source) {
        SegmentLines lines;
        FindLines<Kind::kSamples, kParts>(FixedOf(source.weight, kWholeShare), lines);
        for (int s = 0; s < kSegments; s += kVectorSegments)
            hn::Store(Along<Kind::kSamples>(lines, s), DU16(), share_ + s * kSegmentLanes);
    }

    void SumWeights() {
        std::fill_n(total_, kLanes, 0.0F);
        for (const BlockSource& source : block_.sources) {
            FindEdgeWeights(source);
            for (int at = 0; at < kLanes; ++at) total_[at] += weight_[at];
        }
    }
    void FindEdgeShares(const BlockSource& source) {
        FindEdgeWeights(source);
        for (int at = 0; at < kLanes; ++at) {
            const float total = std::max(total_[at], 1e-12F);  // 0 where nothing is seen
            share_[at] =
                static_cast<std::uint16_t>(static_cast<int>(kWholeShare * (weight_[at] / total)));
        }
    }
    /// What the source counts, where it is seen.
    void FindEdgeWeights(const BlockSource& source) {
        constexpr int kSamples = Kind::kSamples;
        const auto& table = kSegmentTable<kSamples, kParts>;
        const auto& seen = Kind::Windows(source).seen;
        const Corners& corner = source.weight;
        for (int s = 0; s < kSegments; ++s) {
            const float down = static_cast<float>(table.down[s]) / 32;
            const float left = corner[0] + down * (corner[2] - corner[0]);
            const float across = corner[1] + down * (corner[3] - corner[1]) - left;
            const float first = left + static_cast<float>(table.ahead[s]) / 32 * across;
            const float step = across / (kSamples * kParts);
            const unsigned bits = seen[static_cast<std::size_t>(s)];
            for (int i = 0; i < kSegmentLanes; ++i) {
                const int sample = i % kSamples;
                const float value = first + step * static_cast<float>(sample);
                weight_[s * kSegmentLanes + i] =
                    (bits >> sample & 1U) != 0 ? std::max(value, 0.0F) : 0.0F;
            }
        }
    }

    void ClearUnseen() {
        const DU16 du;
        const hn::Rebind<std::uint8_t, DU16> d8;
        const auto empty = hn::Set(d8, Kind::kEmpty);
        for (int s = 0; s < kSegments; s += kVectorSegments) {
            VU16 seen = hn::Zero(du);
            for (const BlockSource& source : block_.sources)
                seen = hn::Or(seen, SeenAt<Kind::kSamples>(Kind::Windows(source), s));
            const auto mask =
                hn::DemoteTo(d8, hn::BitCast(D16(), hn::ShiftRight<8>(seen)));  // 255 or 0
            std::uint8_t* at = bytes_ + s * kSegmentLanes;
            hn::Store(hn::Or(hn::And(mask, hn::Load(d8, at)), hn::AndNot(mask, empty)), d8, at);
        }
    }

    template <Part kPart>
    void Read(const BlockSource& source) {
        const CameraFrame& frame = source.camera->frame();
        if (frame.is_packed()) {
            ReadAs<kPart, Kind::kLogPackedStep>(source);
        } else if (Kind::kChannels == 1 || frame.has_chroma()) {
            ReadAs<kPart, Kind::kLogPackedStep - 1>(source);
        } else {
            ReadAs<kPart, kNoColour>(source);
        }
    }

    template <Part kPart, int kLogStep>
    HWY_NOINLINE void ReadAs(const BlockSource& source) {
        const CameraSampler::Tone tone = source.camera->tone();
        SegmentLines shift[Kind::kChannels] = {};  // read only where source.shifted
        if (source.shifted) FindShift(source, shift);
        const Samples plane = Kind::Plane(source.camera->frame());
        const SampleWindows& windows = Kind::Windows(source);
        for (int s = 0; s < kSegments; s += kVectorSegments) {
            V16 levels = LevelsOf(tone, SamplesAt<kLogStep>(plane, windows, s));
            if (source.shifted) levels = hn::SaturatedAdd(levels, Kind::Shift(shift, s));
            Add<kPart>(levels, s * kSegmentLanes);
        }
    }

    template <int kLogStep>
    static HWY_INLINE VU16 SamplesAt(const Samples& plane, const SampleWindows& windows, int s) {
        if constexpr (kLogStep == kNoColour) {
            return hn::Set(DU16(), std::uint16_t{128 << kSampleBits});
        } else {
            return ReadSegments<Kind::kSamples, kLogStep>(plane, windows, s);
        }
    }
    static HWY_INLINE V16 LevelsOf(const CameraSampler::Tone& tone, VU16 samples) {
        return tone.as_taken ? hn::BitCast(D16(), hn::ShiftRight<kSampleBits - kLevelBits>(samples))
                             : Kind::Levels(tone, samples);
    }

    static HWY_INLINE void FindShift(const BlockSource& source,
                                     SegmentLines (&shift)[Kind::kChannels]) {
        constexpr float kMost = 255;
        for (std::size_t k = 0; k < Kind::kChannels; ++k) {
            Corners corners = source.shift[Kind::kFirstShift + k];
            for (float& value : corners) value = std::clamp(value, -kMost, kMost);
            FindLines<Kind::kSamples, kParts>(FixedOf(corners, 1 << kLevelBits), shift[k]);
        }
    }

    template <Part kPart>
    HWY_INLINE void Add(V16 levels, int at) {
        const D16 d;
        if constexpr (kPart == Part::kWhole) {
            StoreRounded<kLevelBits>(levels, bytes_ + at);
        } else {
            V16 part = hn::MulHigh(levels, hn::BitCast(d, hn::Load(DU16(), share_ + at)));
            if constexpr (kPart == Part::kAnother)
                part = hn::SaturatedAdd(hn::Load(d, sum_ + at), part);
            hn::Store(part, d, sum_ + at);
        }
    }

    const PanoramaBlock& block_;
    HWY_ALIGN std::uint16_t share_[kLanes];  // of one source
    HWY_ALIGN std::int16_t sum_[kLanes];
    HWY_ALIGN float weight_[kLanes];
    HWY_ALIGN float total_[kLanes];
    HWY_ALIGN std::uint8_t bytes_[kLanes];
};

#endif  // HWY_TARGET != HWY_SCALAR

}  // namespace hitchview::algo::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#endif  // include guard by target
