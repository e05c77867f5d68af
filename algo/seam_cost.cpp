#include "algo/seam_cost.hpp"

#include <algorithm>
#include <cmath>
#include <opencv2/core/hal/intrin.hpp>

namespace hitchview::algo {

float GreyPatch::Difference(const GreyPatch& other) const {
    float sum = 0;
    for (std::size_t i = 0; i < cell.size(); ++i) sum += std::abs(cell[i] - other.cell[i]);
    return sum / static_cast<float>(cell.size());
}

namespace {

constexpr int kSide = GreyPatch::kCells * GreyPatch::kCellPx;
using Sums = std::array<int, GreyPatch::kCells * GreyPatch::kCells>;

// How to read the luma of kSide pixels from the first byte of the first one, whatever it means.
struct PlainLuma {
    static constexpr int kStep = 1;
    static cv::v_uint16x8 Read(const std::uint8_t* row) { return cv::v_load_expand(row); }
};
struct YuyvLuma {
    static constexpr int kStep = 2;
    static cv::v_uint16x8 Read(const std::uint8_t* row) {
        return cv::v_reinterpret_as_u16(cv::v_load(row)) & cv::v_setall_u16(255);
    }
};
struct UyvyLuma {
    static constexpr int kStep = 2;
    static cv::v_uint16x8 Read(const std::uint8_t* row) {
        return cv::v_shr<8>(cv::v_reinterpret_as_u16(cv::v_load(row)));
    }
};

/// Top left pixel of a patch.
struct PatchPlace {
    PatchPlace(const CameraFrame& frame, float x, float y)
        : x0(std::clamp(static_cast<int>(x) - kSide / 2, 0, frame.width_px - kSide)),
          y0(std::clamp(static_cast<int>(y) - kSide / 2, 0, frame.height_px - kSide)) {}

    /// First byte of one of its rows.
    [[nodiscard]] const std::uint8_t* Row(const CameraFrame& frame, int step_bytes, int r) const {
        return frame.luma + x0 * step_bytes +
               static_cast<std::ptrdiff_t>(y0 + r) * frame.luma_stride_bytes;
    }

    int x0;
    int y0;
};

template <typename Luma>
Sums SumCells(const CameraFrame& frame, const PatchPlace& place) {
    static_assert(GreyPatch::kCells == 2 && kSide == cv::v_uint16x8::nlanes);
    Sums sum{};
    for (int row = 0; row < GreyPatch::kCells; ++row) {
        cv::v_uint16x8 columns = cv::v_setzero_u16();
        for (int r = 0; r < GreyPatch::kCellPx; ++r) {
            columns = columns + Luma::Read(place.Row(frame, Luma::kStep, row * GreyPatch::kCellPx + r));
        }
        const auto cells = static_cast<std::size_t>(row * GreyPatch::kCells);
        cv::v_uint32x4 left;
        cv::v_uint32x4 right;
        cv::v_expand(columns, left, right);
        sum[cells] = static_cast<int>(cv::v_reduce_sum(left));
        sum[cells + 1] = static_cast<int>(cv::v_reduce_sum(right));
    }
    return sum;
}

Sums SumCells(const CameraFrame& frame, const PatchPlace& place) {
    switch (frame.layout) {
        case PixelLayout::kUyvy:
            return SumCells<UyvyLuma>(frame, place);
        case PixelLayout::kYuyv:
            return SumCells<YuyvLuma>(frame, place);
        default:
            return SumCells<PlainLuma>(frame, place);
    }
}

}  // namespace

GreyPatch ReadGreyPatch(const CameraFrame& frame, float gain, float x, float y) {
    const Sums sum = SumCells(frame, {frame, x, y});
    GreyPatch patch;
    constexpr float kPixels = GreyPatch::kCellPx * GreyPatch::kCellPx;
    for (std::size_t i = 0; i < sum.size(); ++i)
        patch.cell[i] = gain * FullLuma(frame.range, static_cast<float>(sum[i]) / kPixels);
    return patch;
}

void FetchGreyPatch(const CameraFrame& frame, float x, float y) {
    const PatchPlace place(frame, x, y);
    for (int r = 0; r < kSide; ++r)
        __builtin_prefetch(place.Row(frame, frame.is_packed() ? 2 : 1, r));
}

SeamCost::SeamCost(int corners, const SeamCostOptions& options)
    : options_(options),
      history_(static_cast<std::size_t>(corners)),
      cost_(static_cast<std::size_t>(corners), options.unseen) {}

void SeamCost::ObserveBoth(std::size_t corner, const GreyPatch& tractor, const GreyPatch& trailer,
                           const FieldRisk& risk) {
    History& history = history_[corner];
    const float difference = tractor.Difference(trailer);
    if (!history.known) history = {difference, difference, 0, true};
    history.motion =
        std::max(std::abs(difference - history.newest), options_.motion_decay * history.motion);
    history.difference += options_.follow * (difference - history.difference);
    history.newest = difference;
    cost_[corner] = history.difference + options_.motion_weight * history.motion +
                    options_.bend_weight * risk.bend + options_.doubt_weight * risk.doubt_px;
}

void SeamCost::ObserveOne(std::size_t corner) {
    history_[corner].known = false;
    cost_[corner] = options_.unseen;
}

}  // namespace hitchview::algo
