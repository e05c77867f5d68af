#include "algo/seam_cost.hpp"

#include <algorithm>
#include <cmath>

namespace hitchview::algo {

float GreyPatch::Difference(const GreyPatch& other) const {
    float sum = 0;
    for (std::size_t i = 0; i < cell.size(); ++i) sum += std::abs(cell[i] - other.cell[i]);
    return sum / static_cast<float>(cell.size());
}

namespace {

constexpr int kSide = GreyPatch::kCells * GreyPatch::kCellPx;
using Sums = std::array<int, GreyPatch::kCells * GreyPatch::kCells>;

/// Pixels lie kStep bytes apart.
template <int kStep>
Sums SumCells(const SamplePlane& luma, int x0, int y0) {
    std::array<int, kSide> column{};
    Sums sum{};
    for (int cell_row = 0; cell_row < GreyPatch::kCells; ++cell_row) {
        column.fill(0);
        for (int r = 0; r < GreyPatch::kCellPx; ++r) {
            const std::uint8_t* row = luma.row(y0 + cell_row * GreyPatch::kCellPx + r) + x0 * kStep;
            for (int c = 0; c < kSide; ++c) column[static_cast<std::size_t>(c)] += row[c * kStep];
        }
        for (int c = 0; c < kSide; ++c) {
            const int cell = cell_row * GreyPatch::kCells + c / GreyPatch::kCellPx;
            sum[static_cast<std::size_t>(cell)] += column[static_cast<std::size_t>(c)];
        }
    }
    return sum;
}

}  // namespace

GreyPatch ReadGreyPatch(const CameraFrame& frame, float gain, float x, float y) {
    const int x0 = std::clamp(static_cast<int>(x) - kSide / 2, 0, frame.width_px - kSide);
    const int y0 = std::clamp(static_cast<int>(y) - kSide / 2, 0, frame.height_px - kSide);
    const SamplePlane luma = frame.LumaSamples();
    const Sums sum = luma.step_bytes == 1 ? SumCells<1>(luma, x0, y0) : SumCells<2>(luma, x0, y0);
    GreyPatch patch;
    constexpr float kPixels = GreyPatch::kCellPx * GreyPatch::kCellPx;
    for (std::size_t i = 0; i < sum.size(); ++i)
        patch.cell[i] = gain * FullLuma(frame.range, static_cast<float>(sum[i]) / kPixels);
    return patch;
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
