#include "algo/box_mean.hpp"

#include <hwy/cache_control.h>

#include <bit>
#include <opencv2/core/hal/intrin.hpp>
#include <utility>

#include "algo/multiversion.hpp"

namespace hitchview::algo {
namespace {

constexpr int kLanes = 8;
constexpr int kLineBytes = 64;  // of memory, read at once

/// Samples beside each other, or every second byte; then a byte beyond the last one is read.
template <int kStep>
inline cv::v_uint16x8 Load(const std::uint8_t* samples) {
    if constexpr (kStep == 1) return cv::v_load_expand(samples);
    return cv::v_reinterpret_as_u16(cv::v_load(samples)) & cv::v_setall_u16(0xFF);
}

/// Asks for the rows after these: a processor foresees few of so many.
template <int kDown>
inline void PrefetchBelow(const BoxMean::Rows& rows, int at_bytes) {
    for (int v = kDown; v < 2 * kDown; ++v)
        hwy::Prefetch(rows.first + v * rows.stride_bytes + at_bytes);
}

template <int kDown, int kStep>
void SumColumnsOf(const BoxMean::Rows& rows, int count, std::uint16_t* sums) {
    int i = 0;
    for (; i + kLanes < count; i += kLanes) {
        const std::uint8_t* at = rows.first + i * kStep;
        if (i % (kLineBytes / kStep) == 0) PrefetchBelow<kDown>(rows, i * kStep);
        cv::v_uint16x8 sum = Load<kStep>(at);
        for (int v = 1; v < kDown; ++v) sum = sum + Load<kStep>(at + v * rows.stride_bytes);
        cv::v_store(sums + i, sum);
    }
    for (; i < count; ++i) {
        unsigned sum = 0;
        for (int v = 0; v < kDown; ++v) sum += rows.first[v * rows.stride_bytes + i * kStep];
        sums[i] = static_cast<std::uint16_t>(sum);
    }
}

template <int kStep>
void SumColumns(int down, const BoxMean::Rows& rows, int count, std::uint16_t* sums) {
    switch (down) {
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

/// The same for two channels.
HV_MULTIVERSION
void AddTwinPairs(const std::uint16_t* __restrict of, int pairs, std::uint16_t* __restrict sums) {
    for (int i = 0; i < pairs; ++i) {
        sums[2 * i] = static_cast<std::uint16_t>(of[4 * i] + of[4 * i + 2]);
        sums[2 * i + 1] = static_cast<std::uint16_t>(of[4 * i + 1] + of[4 * i + 3]);
    }
}

HV_MULTIVERSION
void Divide(const std::uint16_t* __restrict sums, int shift, int count,
            std::uint8_t* __restrict out) {
    const int half = (1 << shift) / 2;
    for (int i = 0; i < count; ++i) out[i] = static_cast<std::uint8_t>((sums[i] + half) >> shift);
}

}  // namespace

void BoxMean::Take(const Rows& rows, const Box& box, int count, std::uint8_t* means) {
    const int samples = count * box.across * box.channels;
    if (rows.step_bytes == 1) {
        SumColumns<1>(box.down, rows, samples, sums_.data());
    } else {
        SumColumns<2>(box.down, rows, samples, sums_.data());
    }
    for (int left = box.across / 2; left >= 1; left /= 2) {
        if (box.channels == 1) {
            AddPairs(sums_.data(), count * left, pairs_.data());
        } else {
            AddTwinPairs(sums_.data(), count * left, pairs_.data());
        }
        std::swap(sums_, pairs_);
    }
    const int shift = std::countr_zero(static_cast<unsigned>(box.across * box.down));
    Divide(sums_.data(), shift, count * box.channels, means);
}

}  // namespace hitchview::algo
