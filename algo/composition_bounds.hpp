#pragma once

#include "algo/composition.hpp"

namespace hitchview::algo {

/// What no composition of the live mode exceeds, whatever the cameras see (docs/algorithm.md,
/// section 13).
struct CompositionBounds {
    Eigen::Vector3d stabilization;  ///< each component of |S|, as in PoseOffset
    Eigen::Vector3d placement;      ///< of the trailer's view on the tractor's as shown, likewise
    double view_offset_px;          ///< per axis
    double discrepancy_px;          ///< likewise
    double detail_px;               ///< likewise
};

/// Of a free border; `view`: the tractor's. A plane has no bound of its placement.
CompositionBounds BoundsOf(const Projection& canvas, const Projection& view);

/// Shares of the bounds that a composition uses; infinite where something is not finite.
struct OffsetShares {
    double stabilization = 0;
    double placement = 0;
    double view_offset = 0;
    double discrepancy = 0;
    double detail = 0;

    [[nodiscard]] double Largest() const;
    /// The larger one of each.
    void TakeLarger(const OffsetShares& other);
};

OffsetShares SharesOf(const Composition& composition, const CompositionBounds& bounds,
                      const Projection& view);

}  // namespace hitchview::algo
