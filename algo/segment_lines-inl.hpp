// Compiled once for each instruction set, from block_kernel.cpp.
#if defined(HITCHVIEW_ALGO_SEGMENT_LINES_INL_HPP_) == defined(HWY_TARGET_TOGGLE)
#ifdef HITCHVIEW_ALGO_SEGMENT_LINES_INL_HPP_
#undef HITCHVIEW_ALGO_SEGMENT_LINES_INL_HPP_
#else
#define HITCHVIEW_ALGO_SEGMENT_LINES_INL_HPP_
#endif

#include <hwy/highway.h>

#include <algorithm>
#include <cmath>

#include "algo/panorama_block.hpp"

HWY_BEFORE_NAMESPACE();
namespace hitchview::algo::HWY_NAMESPACE {

#if HWY_TARGET != HWY_SCALAR

namespace hn = hwy::HWY_NAMESPACE;

/// Fractional bits of a place in a picture.
inline constexpr int kPlaceBits = 12;

/// The segments of a block of kParts x kParts squares, in each of them kSamples x kSamples samples:
/// row by row. Places in 1/32 of the block.
template <int kSamples, int kParts>
struct SegmentTable {
    static constexpr int kSide = kSamples * kParts;
    static constexpr int kSegments = kSide * kParts;
    static constexpr int kLogSide = kSide == 16 ? 4 : kSide == 8 ? 3 : 2;

    HWY_ALIGN std::int32_t down[kMaxSegments];   ///< of the row
    HWY_ALIGN std::int32_t ahead[kMaxSegments];  ///< of the first sample

    constexpr SegmentTable() : down(), ahead() {
        for (int s = 0; s < kMaxSegments; ++s) {
            const int segment = s % kSegments;  // a vector may have more lanes
            down[s] = (2 * (segment / kParts) + 1) * (16 / kSide);
            ahead[s] = (2 * (segment % kParts) * kSamples + 1) * (16 / kSide);
        }
    }
};
template <int kSamples, int kParts>
inline constexpr SegmentTable<kSamples, kParts> kSegmentTable;

/// Values at the corners of a block.
struct FixedCorners {
    std::int32_t at[4];
};
/// `one` to a unit.
HWY_INLINE FixedCorners FixedOf(const Corners& corners, float one) {
    FixedCorners fixed;
    for (std::size_t k = 0; k < 4; ++k)
        fixed.at[k] = static_cast<std::int32_t>(std::lrint(corners[k] * one));
    return fixed;
}

using D32 = hn::CappedTag<std::int32_t, 16>;
using V32 = hn::Vec<D32>;

/// What is bilinear between the corners: its value at the first sample of some segments, and what
/// it gains from one sample to the next.
struct Segments {
    V32 first;
    V32 step;
};
template <int kSamples, int kParts>
HWY_INLINE Segments SegmentsAt(const FixedCorners& corners, int s) {
    using Table = SegmentTable<kSamples, kParts>;
    const Table& table = kSegmentTable<kSamples, kParts>;
    const D32 d;
    const auto& at = corners.at;
    const V32 down = hn::Load(d, table.down + s);
    const V32 left = hn::Add(hn::Set(d, at[0] << 5), hn::Mul(hn::Set(d, at[2] - at[0]), down));
    const V32 right = hn::Add(hn::Set(d, at[1] << 5), hn::Mul(hn::Set(d, at[3] - at[1]), down));
    const V32 across = hn::Sub(right, left);
    const V32 half = hn::Set(d, 16);
    const V32 to_first =
        hn::ShiftRight<5>(hn::Add(hn::Mul(across, hn::Load(d, table.ahead + s)), half));
    constexpr int kStepBits = 5 + Table::kLogSide;
    return {hn::ShiftRight<5>(hn::Add(hn::Add(left, to_first), half)),
            hn::ShiftRight<kStepBits>(hn::Add(across, hn::Set(d, 1 << (kStepBits - 1))))};
}

/// The same for all segments; values within 16 bits, with a sign or without.
template <int kSamples, int kParts>
HWY_INLINE void FindLines(const FixedCorners& corners, SegmentLines& lines) {
    const D32 d;
    const hn::Rebind<std::int16_t, D32> d16;
    constexpr int kSegments = SegmentTable<kSamples, kParts>::kSegments;
    for (int s = 0; s < kSegments; s += static_cast<int>(hn::Lanes(d))) {
        const Segments segments = SegmentsAt<kSamples, kParts>(corners, s);
        hn::Store(hn::DemoteTo(d16, segments.first), d16,
                  reinterpret_cast<std::int16_t*>(lines.first.data() + s));
        hn::Store(hn::DemoteTo(d16, segments.step), d16, lines.step.data() + s);
    }
}

/// First samples of the windows along one axis, of `count` out of `samples`: so that every segment
/// lies in its own, as far as it lies in the picture. Places are kept modulo 1 << 16: what lies
/// outside means nothing.
template <int kSegments>
HWY_INLINE void PlaceWindows(int samples, int count, const std::int32_t* firsts,
                             std::int32_t* windows, SegmentLines& lines) {
    const D32 d;
    const hn::Rebind<std::uint16_t, D32> d16;
    const V32 last = hn::Set(d, samples - count);
    const V32 bits = hn::Set(d, 0xFFFF);
    for (int s = 0; s < kSegments; s += static_cast<int>(hn::Lanes(d))) {
        const V32 window = hn::Max(hn::Min(hn::Load(d, windows + s), last), hn::Zero(d));
        const V32 first = hn::Sub(hn::Load(d, firsts + s), hn::ShiftLeft<kPlaceBits>(window));
        hn::Store(window, d, windows + s);
        hn::Store(hn::DemoteTo(d16, hn::And(first, bits)), d16, lines.first.data() + s);
    }
}

/// Windows inside the picture's `samples`. kKnown: `count` holds whatever a segment needs;
/// otherwise it is the least number. Returns how many samples a window has.
template <int kSamples, int kParts, bool kKnown>
HWY_INLINE int PlaceAxis(const Corners& corners, int samples, int count, SegmentLines& lines,
                         std::int32_t* windows) {
    constexpr int kSegments = SegmentTable<kSamples, kParts>::kSegments;
    const D32 d;
    const hn::Rebind<std::int16_t, D32> d16;
    const FixedCorners fixed = FixedOf(corners, 1 << kPlaceBits);
    HWY_ALIGN std::int32_t firsts[kMaxSegments];
    V32 widest = hn::Zero(d);
    for (int s = 0; s < kSegments; s += static_cast<int>(hn::Lanes(d))) {
        const auto [first, step] = SegmentsAt<kSamples, kParts>(fixed, s);
        const V32 last = hn::Add(first, hn::Mul(step, hn::Set(d, kSamples - 1)));
        const V32 lowest = hn::ShiftRight<kPlaceBits>(hn::Min(first, last));
        if constexpr (!kKnown) {
            const V32 highest = hn::ShiftRight<kPlaceBits>(hn::Max(first, last));
            widest = hn::Max(widest, hn::Sub(highest, lowest));
        }
        hn::Store(first, d, firsts + s);
        hn::Store(lowest, d, windows + s);
        hn::Store(hn::DemoteTo(d16, step), d16, lines.step.data() + s);
    }
    if constexpr (!kKnown) count = std::max(count, hn::GetLane(hn::MaxOfLanes(d, widest)) + 2);
    PlaceWindows<kSegments>(samples, count, firsts, windows, lines);
    return count;
}

/// Which samples of the segments lie in a picture, from the places of its luma.
template <int kSamples, int kParts>
HWY_INLINE void FindSeen(const Corners& x, const Corners& y, const CameraFrame& frame,
                         SampleWindows& windows) {
    const D32 d;
    const hn::Rebind<std::uint16_t, D32> d16;
    const FixedCorners fixed_x = FixedOf(x, 1 << kPlaceBits);
    const FixedCorners fixed_y = FixedOf(y, 1 << kPlaceBits);
    const V32 right = hn::Set(d, (frame.width_px - 1) << kPlaceBits);
    const V32 bottom = hn::Set(d, (frame.height_px - 1) << kPlaceBits);
    constexpr int kSegments = SegmentTable<kSamples, kParts>::kSegments;
    for (int s = 0; s < kSegments; s += static_cast<int>(hn::Lanes(d))) {
        Segments at_x = SegmentsAt<kSamples, kParts>(fixed_x, s);
        Segments at_y = SegmentsAt<kSamples, kParts>(fixed_y, s);
        V32 seen = hn::Zero(d);
        for (int i = 0; i < kSamples; ++i) {
            // Negative where any of the four distances is.
            const V32 outside = hn::Or(hn::Or(at_x.first, hn::Sub(right, at_x.first)),
                                       hn::Or(at_y.first, hn::Sub(bottom, at_y.first)));
            const V32 bit = hn::Set(d, 1 << i);
            seen = hn::Or(seen, hn::AndNot(hn::BroadcastSignBit(outside), bit));
            at_x.first = hn::Add(at_x.first, at_x.step);
            at_y.first = hn::Add(at_y.first, at_y.step);
        }
        hn::Store(hn::DemoteTo(d16, seen), d16, windows.seen.data() + s);
    }
}

/// How the samples of a picture lie in memory.
struct SampleGrid {
    int cols;
    int rows;
    int step_bytes;
    int stride_bytes;
};

template <int kSamples, int kParts>
HWY_INLINE void PlaceBlock(const Corners& x, const Corners& y, const SampleGrid& grid,
                           SampleWindows& windows) {
    // Two rows would often do, but a branch that can be foreseen is worth one that counts nothing.
    constexpr int kCommonRows = 3;
    HWY_ALIGN std::int32_t cols[kMaxSegments];
    HWY_ALIGN std::int32_t rows[kMaxSegments];
    PlaceAxis<kSamples, kParts, true>(x, grid.cols, 2 * kSamples, windows.x, cols);
    windows.rows = PlaceAxis<kSamples, kParts, false>(y, grid.rows, kCommonRows, windows.y, rows);
    const D32 d;
    constexpr int kSegments = SegmentTable<kSamples, kParts>::kSegments;
    for (int s = 0; s < kSegments; s += static_cast<int>(hn::Lanes(d))) {
        const V32 offset = hn::Add(hn::Mul(hn::Load(d, rows + s), hn::Set(d, grid.stride_bytes)),
                                   hn::Mul(hn::Load(d, cols + s), hn::Set(d, grid.step_bytes)));
        hn::Store(offset, d, windows.offset_bytes.data() + s);
    }
}

#endif  // HWY_TARGET != HWY_SCALAR

}  // namespace hitchview::algo::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#endif  // include guard by target
