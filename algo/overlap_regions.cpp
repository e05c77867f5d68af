#include "algo/overlap_regions.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <opencv2/core.hpp>

#include "algo/feature_mask.hpp"

namespace hitchview::algo {
namespace {

using Eigen::Matrix3d;
using Eigen::Vector2f;

// Of the pixels that are asked.
constexpr int kPitch_px = 4;
constexpr int kRowPitch_px = 16;

/// Columns of `half` of `here` with something that `there` sees.
cv::Rect Shared(const AnalysedRing& here, const AnalysedRing& there, const Matrix3d& R_there_here,
                const cv::Rect& half) {
    int first = half.x + half.width;
    int last = half.x;
    for (int x = half.x; x < half.x + half.width; x += kPitch_px) {
        for (int y = 0; y < half.height; y += kRowPitch_px) {
            const Vector2f at{static_cast<float>(x), static_cast<float>(y)};
            if (!Allows(here.analysis->mask(), at)) continue;
            const Eigen::Vector3d ray = R_there_here * here.view.Ray(here.analysis->ToView(at));
            const Vector2f other = there.analysis->ToAnalysis(there.view.Pixel(ray));
            if (!Allows(there.analysis->mask(), other)) continue;
            first = std::min(first, x);
            last = std::max(last, x + kPitch_px);
        }
    }
    return first < last ? cv::Rect(first, 0, last - first, half.height) : cv::Rect();
}

}  // namespace

double OverlapWidth_rad(const PerUnit<UnitGeometry>& geometry, Overlap overlap) {
    constexpr int kDirections = 360;  // of the half circle on this side
    constexpr double kStep_rad = std::numbers::pi / kDirections;
    const double side = overlap == Overlap::kLeft ? 1 : -1;
    int shared = 0;
    for (int i = 0; i < kDirections; ++i) {
        const double azimuth_rad = side * (i + 0.5) * kStep_rad;
        const Eigen::Vector3d ray{std::cos(azimuth_rad), std::sin(azimuth_rad), 0};
        const bool seen = geometry[Unit::kTractor].SightAlong(ray).has_value() &&
                          geometry[Unit::kTrailer].SightAlong(ray).has_value();
        shared += seen ? 1 : 0;
    }
    return shared * kStep_rad;
}

PerUnit<cv::Rect> SideRegions(const PerUnit<AnalysedRing>& rings, Overlap overlap) {
    PerUnit<cv::Rect> regions;
    const bool left = overlap == Overlap::kLeft;
    for (const Unit unit : kUnits) {
        const SemiSurroundView& view = *rings[unit].analysis;
        const int half_px = view.width_px() / 2;
        const int x = left == (unit == Unit::kTrailer) ? half_px : 0;
        regions[unit] = cv::Rect(x, 0, half_px, view.height_px());
    }
    return regions;
}

PerUnit<cv::Rect> OverlapRegions(const PerUnit<AnalysedRing>& rings,
                                 const Matrix3d& R_tractor_trailer, Overlap overlap,
                                 double tolerance_rad) {
    const PerUnit<Matrix3d> R_other_unit{{R_tractor_trailer.transpose(), R_tractor_trailer}};
    PerUnit<cv::Rect> regions = SideRegions(rings, overlap);
    for (const Unit unit : kUnits) {
        const AnalysedRing& ring = rings[unit];
        const cv::Rect half = regions[unit];
        cv::Rect& region = regions[unit];
        region = Shared(ring, rings[Other(unit)], R_other_unit[unit], half);
        if (region.empty()) continue;
        const auto more_px = static_cast<int>(
            std::ceil(tolerance_rad * ring.view.focal_px * ring.analysis->scale()));
        region.x -= more_px;
        region.width += 2 * more_px;
        region &= half;
    }
    return regions;
}

}  // namespace hitchview::algo
