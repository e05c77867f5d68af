// Compiled once for each instruction set, from block_kernel.cpp.
#if defined(HITCHVIEW_ALGO_SEGMENT_SAMPLES_INL_HPP_) == defined(HWY_TARGET_TOGGLE)
#ifdef HITCHVIEW_ALGO_SEGMENT_SAMPLES_INL_HPP_
#undef HITCHVIEW_ALGO_SEGMENT_SAMPLES_INL_HPP_
#else
#define HITCHVIEW_ALGO_SEGMENT_SAMPLES_INL_HPP_
#endif

#include <hwy/highway.h>

#include "algo/block_kernel.hpp"
#include "algo/segment_lines-inl.hpp"

HWY_BEFORE_NAMESPACE();
namespace hitchview::algo::HWY_NAMESPACE {

#if HWY_TARGET != HWY_SCALAR

namespace hn = hwy::HWY_NAMESPACE;

/// Up to four segments of a block at a time, one in each 128 bits.
using DU16 = hn::CappedTag<std::uint16_t, 32>;
using D16 = hn::RebindToSigned<DU16>;
using D8 = hn::Repartition<std::uint8_t, DU16>;
using VU16 = hn::Vec<DU16>;
using V16 = hn::Vec<D16>;
using V8 = hn::Vec<D8>;

inline constexpr int kVectorSegments = static_cast<int>(hn::MaxLanes(DU16())) / kSegmentLanes;
/// Fractional bits of what is read, and of a level that is shown.
inline constexpr int kSampleBits = 7;
inline constexpr int kLevelBits = 6;

/// 16 bytes from each of some places.
HWY_INLINE V8 LoadEach(const std::uint8_t* const (&from)[4], int at) {
    const D8 d;
    if constexpr (kVectorSegments == 1) {
        return hn::LoadU(d, from[0] + at);
    } else if constexpr (kVectorSegments == 2) {
        const hn::Half<D8> half;
        return hn::Combine(d, hn::LoadU(half, from[1] + at), hn::LoadU(half, from[0] + at));
    } else {
        const hn::Half<D8> half;
        const hn::Half<hn::Half<D8>> quarter;
        const auto low =
            hn::Combine(half, hn::LoadU(quarter, from[1] + at), hn::LoadU(quarter, from[0] + at));
        const auto high =
            hn::Combine(half, hn::LoadU(quarter, from[3] + at), hn::LoadU(quarter, from[2] + at));
        return hn::Combine(d, high, low);
    }
}

/// Bytes of a window, by index, as 16-bit values.
template <int kVectors>
class Window {
 public:
    /// Indices in the lower bytes of `at`.
    explicit Window(VU16 at) {
        const D8 d;
        const DU16 du;
        const V8 bytes = hn::BitCast(d, hn::Or(at, hn::Set(du, std::uint16_t{0xF000})));
        if constexpr (kVectors == 1) {
            low_ = bytes;
        } else {
            // Indices with the top bit read 0. What those from 16 up to it read is not the same
            // everywhere.
            const V8 beyond = hn::SaturatedAdd(bytes, hn::Set(d, std::uint8_t{0x70}));
            low_ = hn::And(beyond, hn::Set(d, std::uint8_t{0x8F}));
            high_ = hn::Sub(bytes, hn::Set(d, std::uint8_t{16}));
        }
    }
    [[nodiscard]] HWY_INLINE VU16 Pick(V8 low, V8 high) const {
        const DU16 du;
        V8 picked = hn::TableLookupBytesOr0(low, low_);
        if constexpr (kVectors == 2) picked = hn::Or(picked, hn::TableLookupBytesOr0(high, high_));
        return hn::BitCast(du, picked);
    }

 private:
    V8 low_;
    V8 high_;
};

/// What a lane of some segments stands for.
template <int kSamples>
struct LaneTable {
    HWY_ALIGN std::uint16_t sample[32];    ///< of the segment
    HWY_ALIGN std::uint16_t second[32];    ///< all ones: of the second channel
    HWY_ALIGN std::uint16_t bit[32];       ///< of the sample
    HWY_ALIGN std::uint8_t broadcast[64];  ///< bytes of the segment's value, of 16 bits

    constexpr LaneTable() : sample(), second(), bit(), broadcast() {
        for (int i = 0; i < 32; ++i) {
            sample[i] = static_cast<std::uint16_t>(i % kSamples);
            bit[i] = static_cast<std::uint16_t>(1 << (i % kSamples));
            second[i] = i % kSegmentLanes < kSamples ? 0 : 0xFFFF;
            broadcast[2 * i] = static_cast<std::uint8_t>(i / kSegmentLanes * 2);
            broadcast[2 * i + 1] = static_cast<std::uint8_t>(i / kSegmentLanes * 2 + 1);
        }
    }
};
template <int kSamples>
inline constexpr LaneTable<kSamples> kLaneTable;

/// Samples of one channel, or of two that lie between each other. Bytes before the first sample
/// may be read.
struct Samples {
    const std::uint8_t* begin;  ///< of what may be read
    int first_byte;             ///< of a row's first sample, from there
    int second_byte;            ///< further to the second channel's
    int stride_bytes;
};

/// Each segment's value to all of its lanes. `eight`: of eight segments.
template <typename T>
HWY_INLINE VU16 Broadcast(const T* eight, V8 index) {
    const D8 d;
    const DU16 du;
    const hn::Repartition<T, DU16> from;
    const V8 all = hn::BitCast(d, hn::LoadDup128(from, eight));
    return hn::BitCast(du, hn::TableLookupBytes(all, index));
}

/// Which of eight segments' values segments s, s + 1... take.
template <int kSamples>
HWY_INLINE V8 BroadcastIndex(int s) {
    const D8 d;
    return hn::Add(hn::Load(d, kLaneTable<kSamples>.broadcast),
                   hn::Set(d, static_cast<std::uint8_t>(2 * (s % kSegmentLanes))));
}

/// All ones in the lanes of segments s, s + 1... that are seen.
template <int kSamples>
HWY_INLINE VU16 SeenAt(const SampleWindows& windows, int s) {
    const DU16 du;
    const VU16 bit = hn::Load(du, kLaneTable<kSamples>.bit);
    const VU16 seen =
        Broadcast(windows.seen.data() + (s - s % kSegmentLanes), BroadcastIndex<kSamples>(s));
    return hn::VecFromMask(du, hn::Eq(hn::And(seen, bit), bit));
}

/// What is linear along segments s, s + 1...; `kSamples` to a segment, then the first again.
template <int kSamples>
HWY_INLINE VU16 Along(const SegmentLines& lines, int s) {
    const DU16 du;
    const LaneTable<kSamples>& lanes = kLaneTable<kSamples>;
    const V8 index = BroadcastIndex<kSamples>(s);
    const int eight = s - s % kSegmentLanes;
    return hn::Add(
        Broadcast(lines.first.data() + eight, index),
        hn::Mul(Broadcast(lines.step.data() + eight, index), hn::Load(du, lanes.sample)));
}

HWY_INLINE VU16 AtLeast0(VU16 with_sign) {
    return hn::BitCast(DU16(), hn::Max(hn::BitCast(D16(), with_sign), hn::Zero(D16())));
}

/// What is read for segments s, s + 1..., 8.7 fixed point. Samples lie 1 << kLogStep bytes apart.
template <int kSamples, int kLogStep>
HWY_INLINE VU16 ReadSegments(const Samples& plane, const SampleWindows& windows, int s) {
    const D16 d;
    const DU16 du;
    constexpr int kWindow = 2 * kSamples;
    constexpr int kVectors = kWindow * (1 << kLogStep) / 16;
    const LaneTable<kSamples>& lanes = kLaneTable<kSamples>;
    const VU16 byte = hn::Add(hn::Set(du, static_cast<std::uint16_t>(plane.first_byte)),
                              hn::And(hn::Load(du, lanes.second),
                                      hn::Set(du, static_cast<std::uint16_t>(plane.second_byte))));
    VU16 px = Along<kSamples>(windows.x, s);
    VU16 py = Along<kSamples>(windows.y, s);
    // Colour ends a little before the picture does; that of packed pixels has all of its rows.
    if constexpr (kSamples < kSegmentLanes) px = AtLeast0(px);
    if constexpr (kSamples < kSegmentLanes && kVectors == 1) {
        const auto last_row = static_cast<std::uint16_t>((windows.rows - 1) << kPlaceBits);
        py = hn::Min(AtLeast0(py), hn::Set(du, last_row));
    }
    const VU16 whole = hn::ShiftRight<kPlaceBits>(px);
    const VU16 beside = hn::Min(hn::Add(whole, hn::Set(du, std::uint16_t{1})),
                                hn::Set(du, std::uint16_t{kWindow - 1}));
    const Window<kVectors> a(hn::Add(hn::ShiftLeft<kLogStep>(whole), byte));
    const Window<kVectors> b(hn::Add(hn::ShiftLeft<kLogStep>(beside), byte));
    const VU16 b_share =
        hn::And(hn::ShiftRight<kPlaceBits - 8>(px), hn::Set(du, std::uint16_t{255}));
    const VU16 a_share = hn::Sub(hn::Set(du, std::uint16_t{256}), b_share);

    const std::uint8_t* from[4];
    for (int g = 0; g < kVectorSegments; ++g)
        from[g] = plane.begin + windows.offset_bytes[static_cast<std::size_t>(s + g)];
    VU16 sum = hn::Zero(du);
    for (int k = 0; k < windows.rows; ++k) {
        const V8 low = LoadEach(from, 0);
        const V8 high = kVectors == 2 ? LoadEach(from, 16) : low;
        const VU16 along =
            hn::Add(hn::Mul(a.Pick(low, high), a_share), hn::Mul(b.Pick(low, high), b_share));
        const VU16 away = hn::BitCast(du, hn::Abs(hn::BitCast(d, py)));
        const VU16 share = hn::ShiftLeft<15 - kPlaceBits>(
            hn::SaturatedSub(hn::Set(du, std::uint16_t{1 << kPlaceBits}), away));
        sum = hn::Add(sum, hn::MulHigh(along, share));
        py = hn::Sub(py, hn::Set(du, std::uint16_t{1 << kPlaceBits}));
        for (int g = 0; g < kVectorSegments; ++g) from[g] += plane.stride_bytes;
    }
    return sum;
}

HWY_INLINE Samples LumaOf(const CameraFrame& frame) {
    const SamplePlane plane = frame.LumaSamples();
    return {.begin = frame.luma,
            .first_byte = static_cast<int>(plane.first - frame.luma),
            .second_byte = 0,
            .stride_bytes = plane.stride_bytes};
}

/// u in the lower half of each segment's lanes, v in the upper one.
HWY_INLINE Samples ChromaOf(const CameraFrame& frame) {
    const SamplePlane plane = frame.ChromaSamples(0);
    return {.begin = frame.chroma,
            .first_byte = static_cast<int>(plane.first - frame.chroma),
            .second_byte = plane.step_bytes / 2,
            .stride_bytes = plane.stride_bytes};
}

#endif  // HWY_TARGET != HWY_SCALAR

}  // namespace hitchview::algo::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#endif  // include guard by target
