#include "algo/grey_reduction.hpp"

#include <hwy/cache_control.h>

#include <bit>
#include <opencv2/core/hal/intrin.hpp>
#include <utility>

#include "algo/multiversion.hpp"

namespace hitchview::algo {
namespace {

/// Rows of samples below each other.
struct Rows {
    const std::uint8_t* first;
    std::ptrdiff_t stride_bytes;
};

constexpr int kLanes = 8;
constexpr int kLineBytes = 64;  // of memory, read at once

/// Samples beside each other, or every second byte; then a byte beyond the last one is read.
template <int kStep>
inline cv::v_uint16x8 Load(const std::uint8_t* samples) {
    if constexpr (kStep == 1) return cv::v_load_expand(samples);
    return cv::v_reinterpret_as_u16(cv::v_load(samples)) & cv::v_setall_u16(0xFF);
}

/// Asks for the rows after these: a processor foresees few of so many.
template <int kSide>
inline void PrefetchBelow(const Rows& rows, int at_bytes) {
    for (int v = kSide; v < 2 * kSide; ++v)
        hwy::Prefetch(rows.first + v * rows.stride_bytes + at_bytes);
}

template <int kSide, int kStep>
void SumColumnsOf(const Rows& rows, int count, std::uint16_t* sums) {
    int i = 0;
    for (; i + kLanes < count; i += kLanes) {
        const std::uint8_t* at = rows.first + i * kStep;
        if (i % (kLineBytes / kStep) == 0) PrefetchBelow<kSide>(rows, i * kStep);
        cv::v_uint16x8 sum = Load<kStep>(at);
        for (int v = 1; v < kSide; ++v) sum = sum + Load<kStep>(at + v * rows.stride_bytes);
        cv::v_store(sums + i, sum);
    }
    for (; i < count; ++i) {
        unsigned sum = 0;
        for (int v = 0; v < kSide; ++v) sum += rows.first[v * rows.stride_bytes + i * kStep];
        sums[i] = static_cast<std::uint16_t>(sum);
    }
}

template <int kStep>
void SumColumns(int side, const Rows& rows, int count, std::uint16_t* sums) {
    switch (side) {
        case 1:
            return SumColumnsOf<1, kStep>(rows, count, sums);
        case 2:
            return SumColumnsOf<2, kStep>(rows, count, sums);
        case 4:
            return SumColumnsOf<4, kStep>(rows, count, sums);
        default:
            return SumColumnsOf<8, kStep>(rows, count, sums);
    }
}

HV_MULTIVERSION
void AddPairs(const std::uint16_t* __restrict of, int pairs, std::uint16_t* __restrict sums) {
    for (int i = 0; i < pairs; ++i) sums[i] = static_cast<std::uint16_t>(of[2 * i] + of[2 * i + 1]);
}

HV_MULTIVERSION
void Divide(const std::uint16_t* __restrict sums, int shift, int count,
            std::uint8_t* __restrict out) {
    const int half = (1 << shift) / 2;
    for (int i = 0; i < count; ++i) out[i] = static_cast<std::uint8_t>((sums[i] + half) >> shift);
}

}  // namespace

GreyReduction::GreyReduction(int side, int max_width_px)
    : side_(side), sums_(static_cast<std::size_t>(max_width_px * side)), pairs_(sums_.size()) {}

void GreyReduction::Reduce(const SamplePlane& plane, const cv::Rect& used, cv::Mat1b& reduced) {
    const int samples = used.width * side_;
    const int shift = 2 * std::countr_zero(static_cast<unsigned>(side_));
    for (int y = used.y; y < used.br().y; ++y) {
        const Rows rows{plane.row(y * side_) + used.x * side_ * plane.step_bytes,
                        plane.stride_bytes};
        if (plane.step_bytes == 1) {
            SumColumns<1>(side_, rows, samples, sums_.data());
        } else {
            SumColumns<2>(side_, rows, samples, sums_.data());
        }
        for (int width = samples / 2; width >= used.width; width /= 2) {
            AddPairs(sums_.data(), width, pairs_.data());
            std::swap(sums_, pairs_);
        }
        Divide(sums_.data(), shift, used.width, reduced[y] + used.x);
    }
}

}  // namespace hitchview::algo
