// Compiled once for each instruction set, from block_kernel.cpp.
#if defined(HITCHVIEW_ALGO_BLOCK_KERNEL_INL_HPP_) == defined(HWY_TARGET_TOGGLE)
#ifdef HITCHVIEW_ALGO_BLOCK_KERNEL_INL_HPP_
#undef HITCHVIEW_ALGO_BLOCK_KERNEL_INL_HPP_
#else
#define HITCHVIEW_ALGO_BLOCK_KERNEL_INL_HPP_
#endif

#include <hwy/highway.h>

#include <algorithm>
#include <cmath>

#include "algo/block_kernel.hpp"

HWY_BEFORE_NAMESPACE();
namespace hitchview::algo::HWY_NAMESPACE {

#if HWY_TARGET != HWY_SCALAR

namespace hn = hwy::HWY_NAMESPACE;

/// Up to four rows of a block at a time, one in each 128 bits.
using DU16 = hn::CappedTag<std::uint16_t, 32>;
using D16 = hn::RebindToSigned<DU16>;
using D8 = hn::Repartition<std::uint8_t, DU16>;
using VU16 = hn::Vec<DU16>;
using V16 = hn::Vec<D16>;
using V8 = hn::Vec<D8>;

inline constexpr int kVectorRows = static_cast<int>(hn::MaxLanes(DU16())) / kBlockLanes;
/// Fractional bits of a place in a picture, of what is read there, and of a level that is shown.
inline constexpr int kPlaceBits = 12;
inline constexpr int kSampleBits = 7;
inline constexpr int kLevelBits = 6;

HWY_ALIGN inline constexpr std::int32_t kOdd[kBlockLanes] = {1, 3, 5, 7, 9, 11, 13, 15};

/// Windows inside the picture's `samples`. kEnough: least_count holds whatever the block needs;
/// otherwise as many as it needs, if those are more.
template <int kSide, bool kEnough>
HWY_INLINE void PlaceRows(const Corners& corners, int samples, int least_count, WindowAxis& axis) {
    constexpr int kLogSide = kSide == 8 ? 3 : 2;
    const hn::CappedTag<std::int32_t, kSide> d;
    const hn::Rebind<std::uint16_t, decltype(d)> du16;
    const hn::Rebind<std::int16_t, decltype(d)> d16;
    std::int32_t fixed[4];
    for (std::size_t k = 0; k < 4; ++k)
        fixed[k] = static_cast<std::int32_t>(corners[k] * (1 << kPlaceBits) + 0.5F);
    HWY_ALIGN std::int32_t firsts[kSide];
    auto widest = hn::Zero(d);
    const auto half = hn::Set(d, 8);  // of the 4 more fractional bits that make all this exact
    for (int r = 0; r < kSide; r += static_cast<int>(hn::Lanes(d))) {
        const auto down = hn::ShiftLeft<3 - kLogSide>(hn::Load(d, kOdd + r));
        const auto left =
            hn::Add(hn::Set(d, fixed[0] << 4), hn::Mul(hn::Set(d, fixed[2] - fixed[0]), down));
        const auto right =
            hn::Add(hn::Set(d, fixed[1] << 4), hn::Mul(hn::Set(d, fixed[3] - fixed[1]), down));
        const auto across = hn::Sub(right, left);
        const auto half_step = hn::ShiftRight<kLogSide + 1>(across);
        const auto first = hn::ShiftRight<4>(hn::Add(hn::Add(left, half_step), half));
        const auto step = hn::ShiftRight<4>(hn::Add(hn::ShiftRight<kLogSide>(across), half));
        const auto last = hn::Add(first, hn::Sub(hn::ShiftLeft<kLogSide>(step), step));
        const auto lowest = hn::ShiftRight<kPlaceBits>(hn::Min(first, last));
        if constexpr (!kEnough) {
            const auto highest = hn::ShiftRight<kPlaceBits>(hn::Max(first, last));
            widest = hn::Max(widest, hn::Sub(highest, lowest));
        }
        hn::Store(first, d, firsts + r);
        hn::Store(lowest, d, axis.window.data() + r);
        hn::Store(hn::DemoteTo(d16, step), d16, axis.step.data() + r);
    }
    axis.count = least_count;
    if constexpr (!kEnough)
        axis.count = std::max(least_count, hn::GetLane(hn::MaxOfLanes(d, widest)) + 2);
    const auto last_window = hn::Set(d, samples - axis.count);
    for (int r = 0; r < kSide; r += static_cast<int>(hn::Lanes(d))) {
        const auto window = hn::Min(hn::Load(d, axis.window.data() + r), last_window);
        const auto first = hn::Sub(hn::Load(d, firsts + r), hn::ShiftLeft<kPlaceBits>(window));
        hn::Store(window, d, axis.window.data() + r);
        hn::Store(hn::DemoteTo(du16, first), du16, axis.first.data() + r);
    }
}

template <int kSide>
HWY_INLINE void PlaceWindows(const Corners& x, const Corners& y, int cols, int rows,
                             SampleWindows& windows) {
    // Two rows would often do, but a branch that can be foreseen is worth one that counts nothing.
    constexpr int kCommonRows = 3;
    PlaceRows<kSide, true>(x, cols, 2 * kSide, windows.x);
    PlaceRows<kSide, false>(y, rows, kCommonRows, windows.y);
}

/// 16 bytes from each of some places.
HWY_INLINE V8 LoadRows(const std::uint8_t* const (&from)[4], int at) {
    const D8 d;
    if constexpr (kVectorRows == 1) {
        return hn::LoadU(d, from[0] + at);
    } else if constexpr (kVectorRows == 2) {
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
            low_ = hn::SaturatedAdd(bytes, hn::Set(d, std::uint8_t{0x70}));
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

/// What a lane of some rows stands for.
template <int kSide>
struct LaneTable {
    HWY_ALIGN std::uint16_t sample[32];    ///< of the row
    HWY_ALIGN std::uint16_t second[32];    ///< all ones: of the second channel
    HWY_ALIGN std::uint8_t broadcast[64];  ///< bytes of the row's value, of 16 bits

    constexpr LaneTable() : sample(), second(), broadcast() {
        for (int i = 0; i < 32; ++i) {
            sample[i] = static_cast<std::uint16_t>(i % kSide);
            second[i] = i % kBlockLanes < kSide ? 0 : 0xFFFF;
            broadcast[2 * i] = static_cast<std::uint8_t>(i / kBlockLanes * 2);
            broadcast[2 * i + 1] = static_cast<std::uint8_t>(i / kBlockLanes * 2 + 1);
        }
    }
};
template <int kSide>
inline constexpr LaneTable<kSide> kLaneTable;

/// Samples of one channel, or of two that lie between each other. Bytes before the first sample
/// may be read.
struct Samples {
    const std::uint8_t* begin;  ///< of what may be read
    int first_byte;             ///< of a row's first sample, from there
    int second_byte;            ///< further to the second channel's
    int stride_bytes;
    int cols;
    int rows;
};

/// One row's value to all of its lanes.
template <typename T>
HWY_INLINE VU16 Broadcast(const T* rows, V8 index) {
    const D8 d;
    const DU16 du;
    const hn::Repartition<T, DU16> from;
    const V8 all = hn::BitCast(d, hn::LoadDup128(from, rows));
    return hn::BitCast(du, hn::TableLookupBytes(all, index));
}

/// What is read, 8.7 fixed point. Samples lie 1 << kLogStep bytes apart.
template <int kSide, int kLogStep>
HWY_INLINE void ReadPlane(const Samples& plane, const SampleWindows& windows,
                          std::uint16_t* samples) {
    const D16 d;
    const DU16 du;
    const D8 d8;
    constexpr int kWindow = 2 * kSide;  // samples
    constexpr int kVectors = kWindow * (1 << kLogStep) / 16;
    const auto& [x, y] = windows;
    const LaneTable<kSide>& lanes = kLaneTable<kSide>;
    const VU16 sample = hn::Load(du, lanes.sample);
    const VU16 byte = hn::Add(hn::Set(du, static_cast<std::uint16_t>(plane.first_byte)),
                              hn::And(hn::Load(du, lanes.second),
                                      hn::Set(du, static_cast<std::uint16_t>(plane.second_byte))));
    const VU16 last = hn::Set(du, std::uint16_t{kWindow - 1});
    const VU16 one = hn::Set(du, std::uint16_t{1});
    for (int r0 = 0; r0 < kSide; r0 += kVectorRows) {
        const V8 index =
            hn::Add(hn::Load(d8, lanes.broadcast), hn::Set(d8, static_cast<std::uint8_t>(2 * r0)));
        const VU16 px = hn::Add(Broadcast(x.first.data(), index),
                                hn::Mul(Broadcast(x.step.data(), index), sample));
        VU16 py = hn::Add(Broadcast(y.first.data(), index),
                          hn::Mul(Broadcast(y.step.data(), index), sample));
        const VU16 whole = hn::ShiftRight<kPlaceBits>(px);
        const VU16 beside = hn::Min(hn::Add(whole, one), last);
        const Window<kVectors> a(hn::Add(hn::ShiftLeft<kLogStep>(whole), byte));
        const Window<kVectors> b(hn::Add(hn::ShiftLeft<kLogStep>(beside), byte));
        const VU16 b_share =
            hn::And(hn::ShiftRight<kPlaceBits - 8>(px), hn::Set(du, std::uint16_t{255}));
        const VU16 a_share = hn::Sub(hn::Set(du, std::uint16_t{256}), b_share);

        const std::uint8_t* from[4];
        for (int g = 0; g < kVectorRows; ++g) {
            const auto r = static_cast<std::size_t>(r0 + g);
            from[g] = plane.begin + static_cast<std::ptrdiff_t>(y.window[r]) * plane.stride_bytes +
                      (x.window[r] << kLogStep);
        }
        VU16 sum = hn::Zero(du);
        for (int k = 0; k < y.count; ++k) {
            const V8 low = LoadRows(from, 0);
            const V8 high = kVectors == 2 ? LoadRows(from, 16) : low;
            const VU16 along =
                hn::Add(hn::Mul(a.Pick(low, high), a_share), hn::Mul(b.Pick(low, high), b_share));
            const VU16 away = hn::BitCast(du, hn::Abs(hn::BitCast(d, py)));
            const VU16 share = hn::ShiftLeft<15 - kPlaceBits>(
                hn::SaturatedSub(hn::Set(du, std::uint16_t{1 << kPlaceBits}), away));
            sum = hn::Add(sum, hn::MulHigh(along, share));
            py = hn::Sub(py, hn::Set(du, std::uint16_t{1 << kPlaceBits}));
            for (int g = 0; g < kVectorRows; ++g) from[g] += plane.stride_bytes;
        }
        hn::Store(sum, du, samples + r0 * kBlockLanes);
    }
}

HWY_INLINE Samples LumaOf(const CameraFrame& frame) {
    const SamplePlane plane = frame.LumaSamples();
    return {.begin = frame.luma,
            .first_byte = static_cast<int>(plane.first - frame.luma),
            .second_byte = 0,
            .stride_bytes = plane.stride_bytes,
            .cols = plane.cols,
            .rows = plane.rows};
}

HWY_INLINE Samples ChromaOf(const CameraFrame& frame) {
    const SamplePlane plane = frame.ChromaSamples(0);
    return {.begin = frame.chroma,
            .first_byte = static_cast<int>(plane.first - frame.chroma),
            .second_byte = plane.step_bytes / 2,
            .stride_bytes = plane.stride_bytes,
            .cols = plane.cols,
            .rows = plane.rows};
}

HWY_INLINE void ReadLuma(const BlockSource& source, std::uint16_t* samples) {
    const CameraFrame& frame = source.camera->frame();
    if (frame.is_packed()) {
        ReadPlane<8, 1>(LumaOf(frame), source.luma, samples);
    } else {
        ReadPlane<8, 0>(LumaOf(frame), source.luma, samples);
    }
}

/// u in the lower half of each row's lanes, v in the upper one.
HWY_INLINE void ReadChroma(const BlockSource& source, std::uint16_t* samples) {
    const CameraFrame& frame = source.camera->frame();
    if (!frame.has_chroma()) {
        std::fill_n(samples, 4 * kBlockLanes, std::uint16_t{128 << kSampleBits});
        return;
    }
    if (frame.is_packed()) {
        ReadPlane<4, 2>(ChromaOf(frame), source.chroma, samples);
    } else {
        ReadPlane<4, 1>(ChromaOf(frame), source.chroma, samples);
    }
}

#endif  // HWY_TARGET != HWY_SCALAR

}  // namespace hitchview::algo::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#endif  // include guard by target
