#include "algo/composition_bounds.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

#include "algo/unified_options.hpp"

namespace hitchview::algo {
namespace {

constexpr double kBeyond = std::numeric_limits<double>::infinity();

/// NaN counts as infinite.
double Share(double largest, double bound) {
    const double share = largest / bound;
    return std::isfinite(share) ? share : kBeyond;
}

double Share(const VertexField& field, double bound) {
    return field.allFinite() ? Share(field.cwiseAbs().maxCoeff(), bound) : kBeyond;
}

double Share(const CornerField& field, double bound) {
    double largest = 0;
    for (int row = 0; row < field.rows(); ++row) {
        for (int col = 0; col < field.cols(); ++col) {
            if (!field.at(row, col).allFinite()) return kBeyond;
            largest = std::max<double>(largest, field.at(row, col).cwiseAbs().maxCoeff());
        }
    }
    return Share(largest, bound);
}

double Share(const Eigen::Vector3d& value, const Eigen::Vector3d& bound) {
    return value.allFinite() ? value.cwiseAbs().cwiseQuotient(bound).maxCoeff() : kBeyond;
}

}  // namespace

CompositionBounds BoundsOf(const Projection& canvas, const Projection& view) {
    const Eigen::Vector3d hitch = HitchSmootherOptions(view).wall;
    return {.stabilization = StabilizerOptions(canvas, view, {}).wall,
            .placement = MostPlacement(view) + hitch,
            .view_offset_px = MostResidual_px(view),
            .discrepancy_px = MostDiscrepancy_px(canvas),
            .detail_px = MostDetail_px(canvas)};
}

double OffsetShares::Largest() const {
    return std::max({stabilization, placement, view_offset, discrepancy, detail});
}

void OffsetShares::TakeLarger(const OffsetShares& other) {
    stabilization = std::max(stabilization, other.stabilization);
    placement = std::max(placement, other.placement);
    view_offset = std::max(view_offset, other.view_offset);
    discrepancy = std::max(discrepancy, other.discrepancy);
    detail = std::max(detail, other.detail);
}

OffsetShares SharesOf(const Composition& composition, const CompositionBounds& bounds,
                      const Projection& view) {
    OffsetShares shares;
    for (const Unit unit : kUnits) {
        shares.stabilization =
            std::max(shares.stabilization,
                     Share(composition.stabilization[unit].value, bounds.stabilization));
        shares.view_offset = std::max(shares.view_offset,
                                      Share(composition.view_offset[unit], bounds.view_offset_px));
    }
    const Eigen::Matrix3d placed = composition.M_canvas_view[Unit::kTractor].inverse() *
                                   composition.M_canvas_view[Unit::kTrailer];
    shares.placement = Share(ToOffset(view, placed).value, bounds.placement);
    shares.discrepancy = Share(composition.discrepancy, bounds.discrepancy_px);
    shares.detail = Share(composition.detail, bounds.detail_px);
    return shares;
}

}  // namespace hitchview::algo
