#pragma once

#include <Eigen/Core>

#include "algo/corner_grid.hpp"
#include "algo/unit.hpp"

namespace hitchview::algo {

/// Columns of corners, both ends included.
struct CornerColumns {
    int first = 0;
    int last = -1;

    [[nodiscard]] bool empty() const { return last < first; }
    /// From the first of both to the last of both.
    static CornerColumns Together(const CornerColumns& a, const CornerColumns& b);
};

struct DetailPastOptions {
    double sure_px = 2;        ///< up to this doubt a corner is as its samples say
    double unsure_px = 5;      ///< from this doubt on it hardly leaves what it was before
    double least_gain = 0.35;  ///< share of the way that it then goes, per frame,
    double most_step_px = 3;   ///< but at most so far
};

/// What the discrepancy was at the corners in the fit before. Where samples disagree, as at night,
/// or are gone, a corner leaves that by small steps, so that noise does not make a seam leap; where
/// they agree it is as they say at once (docs/algorithm.md, section 8). Memory is taken at
/// construction; the two overlaps may be handled at once on two threads, each call for one.
class DetailPast {
 public:
    DetailPast(const Projection& canvas, const DetailPastOptions& options);

    /// Of an overlap: as after construction.
    void Forget(Overlap overlap) { columns_[overlap] = {}; }
    /// Where there is a past.
    [[nodiscard]] const CornerColumns& columns(Overlap overlap) const { return columns_[overlap]; }
    /// Holds back what is in doubt in a fit, there. `mesh_part`: of the discrepancy, `detail`: its
    /// rest; both px. `doubt_px`: of their sum.
    void Hold(Overlap overlap, const CornerField& mesh_part, const CornerScalars& doubt_px,
              CornerField& detail);
    /// Makes this fit the past, but for columns at the rims that have no detail any more.
    void Remember(Overlap overlap, CornerColumns columns, const CornerField& mesh_part,
                  const CornerField& detail);

 private:
    void JudgeSureness(const CornerColumns& columns, const CornerScalars& doubt_px);
    [[nodiscard]] Eigen::Vector2f SureChange(int row, const CornerColumns& columns,
                                             const CornerField& mesh_part,
                                             const CornerField& detail) const;
    [[nodiscard]] Eigen::Vector2f Step(const Eigen::Vector2f& change_px, float sureness) const;

    DetailPastOptions options_;
    CornerField discrepancy_;  // the mesh's part included, px
    CornerScalars sureness_;   // 1 where the samples agree, 0 where they do not, or are none
    PerOverlap<CornerColumns> columns_;
};

}  // namespace hitchview::algo
