#include "algo/seam_cost.hpp"

#include <algorithm>
#include <cmath>

namespace hitchview::algo {

float GreyPatch::Difference(const GreyPatch& other) const {
    float sum = 0;
    for (std::size_t i = 0; i < cell.size(); ++i) sum += std::abs(cell[i] - other.cell[i]);
    return sum / static_cast<float>(cell.size());
}

GreyPatch ReadGreyPatch(const CameraFrame& frame, float gain, float x, float y) {
    constexpr int kSide = GreyPatch::kCells * GreyPatch::kCellPx;
    const int x0 = std::clamp(static_cast<int>(x) - kSide / 2, 0, frame.width_px - kSide);
    const int y0 = std::clamp(static_cast<int>(y) - kSide / 2, 0, frame.height_px - kSide);
    std::array<int, GreyPatch::kCells * GreyPatch::kCells> sum{};
    const SamplePlane luma = frame.LumaSamples();
    for (int r = 0; r < kSide; ++r) {
        const std::uint8_t* row = luma.row(y0 + r) + x0 * luma.step_bytes;
        for (int c = 0; c < kSide; ++c) {
            const int cell = r / GreyPatch::kCellPx * GreyPatch::kCells + c / GreyPatch::kCellPx;
            sum[static_cast<std::size_t>(cell)] += row[c * luma.step_bytes];
        }
    }
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
