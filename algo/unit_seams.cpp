#include "algo/unit_seams.hpp"

#include <algorithm>
#include <cmath>

#include "algo/smooth_step.hpp"

namespace hitchview::algo {
namespace {

/// A column belongs to the overlap if this share of its corners is covered by both units.
constexpr double kOverlapShare = 0.6;

}  // namespace

UnitSeams::UnitSeams(const Projection& canvas, int rows, int cols, double spacing_px,
                     const SeamOptions& options)
    : ring_(canvas.IsRing()),
      rows_(rows),
      cols_(cols),
      spacing_px_(spacing_px),
      options_(options),
      path_{{SeamPath(rows, cols, spacing_px, options.path),
             SeamPath(rows, cols, spacing_px, options.path)}} {}

SeamPath::Range UnitSeams::FindOverlap(const Coverage& covered, int from_col, int to_col) const {
    SeamPath::Range range;
    for (int col = from_col; col < to_col; ++col) {
        int both = 0;
        int any = 0;
        for (int row = 0; row < rows_; ++row) {
            const auto at = static_cast<std::size_t>(row * cols_ + col);
            const bool tractor = covered[Unit::kTractor][at] != 0;
            const bool trailer = covered[Unit::kTrailer][at] != 0;
            both += tractor && trailer ? 1 : 0;
            any += tractor || trailer ? 1 : 0;
        }
        if (any == 0 || both < kOverlapShare * any) continue;
        if (range.empty()) range.first = col;
        range.last = col;
    }
    return range;
}

void UnitSeams::FindOverlaps(const Coverage& covered) {
    if (ring_) range_[Overlap::kLeft] = FindOverlap(covered, 0, cols_ / 2);
    range_[Overlap::kRight] = FindOverlap(covered, ring_ ? cols_ / 2 : 0, cols_);
}

void UnitSeams::FollowOne(Overlap overlap, std::span<const float> cost) {
    const SeamPath::Range& range = range_[overlap];
    SeamPath& path = path_[overlap];
    if (range.empty()) {
        const double between_px = 0.5 * (middle_px_[Unit::kTractor] + middle_px_[Unit::kTrailer]);
        if (!ring_) path.FollowColumn(between_px, options_.tracking_gain);
    } else if (cost.empty()) {
        const double middle_px = 0.5 * (range.first + range.last) * spacing_px_ - 0.5;
        path.FollowColumn(middle_px, options_.tracking_gain);
    } else {
        path.FollowCheapest(range, cost);
    }
}

void UnitSeams::Follow(std::span<const float> cost) {
    if (ring_) FollowOne(Overlap::kLeft, cost);
    FollowOne(Overlap::kRight, cost);
}

double UnitSeams::Beyond(Overlap overlap, int row, double x_px) const {
    const double off_px = x_px - path_[overlap].x_px(row);
    if (std::abs(off_px) >= options_.half_width_px) return off_px > 0 ? 1 : 0;  // as mostly
    return SmoothStep(off_px / (2 * options_.half_width_px) + 0.5);
}

double UnitSeams::TractorShare(int row, double x_px) const {
    const double right_of_right = Beyond(Overlap::kRight, row, x_px);
    if (!ring_) {
        const bool trailer_left = middle_px_[Unit::kTrailer] < middle_px_[Unit::kTractor];
        return trailer_left ? right_of_right : 1 - right_of_right;
    }
    return std::min(Beyond(Overlap::kLeft, row, x_px), 1 - right_of_right);
}

}  // namespace hitchview::algo
