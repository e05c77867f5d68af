#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "algo/projection.hpp"
#include "algo/seam_path.hpp"
#include "algo/unit.hpp"

namespace hitchview::algo {

struct SeamOptions {
    double half_width_px = 8;     ///< of the strip in which fine detail is blended
    double tracking_gain = 0.08;  ///< share of the way to a straight seam's place, per frame
    SeamPathOptions path = {};
};

/// Where the panorama changes from one unit to the other: one line in each overlap, on the corners
/// of the composed map. On a ring the left overlap lies in the left half and the tractor between
/// the two lines.
class UnitSeams {
 public:
    using Coverage = PerUnit<std::vector<std::uint8_t>>;  ///< not 0: seen by the unit; per corner

    /// A grid of `rows` x `cols` corners, `spacing_px` apart.
    UnitSeams(const Projection& canvas, int rows, int cols, double spacing_px,
              const SeamOptions& options);

    /// First: the columns that both units see in most of their height.
    void FindOverlaps(const Coverage& covered);
    [[nodiscard]] const SeamPath::Range& overlap(Overlap overlap) const { return range_[overlap]; }

    /// Then, in a plane: the columns of the middles of the two views.
    void PlaceViews(const PerUnit<double>& middle_px) { middle_px_ = middle_px; }
    /// Last. `cost` per corner; empty: the lines stay straight, in the middle of their overlaps.
    /// A ring's line whose overlap is gone stays where it is, a plane's goes between the views.
    void Follow(std::span<const float> cost);

    /// What the tractor shows of canvas column `x_px` in corner row `row`: 0..1.
    [[nodiscard]] double TractorShare(int row, double x_px) const;
    [[nodiscard]] const SeamPath& path(Overlap overlap) const { return path_[overlap]; }

 private:
    [[nodiscard]] SeamPath::Range FindOverlap(const Coverage& covered, int from_col,
                                              int to_col) const;
    [[nodiscard]] double Beyond(Overlap overlap, int row, double x_px) const;
    void FollowOne(Overlap overlap, std::span<const float> cost);

    bool ring_;
    int rows_;
    int cols_;
    double spacing_px_;
    SeamOptions options_;
    PerOverlap<SeamPath::Range> range_;
    PerUnit<double> middle_px_;
    PerOverlap<SeamPath> path_;
};

}  // namespace hitchview::algo
