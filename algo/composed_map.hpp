#pragma once

#include <memory>
#include <vector>

#include "algo/camera_frame.hpp"
#include "algo/composition.hpp"
#include "algo/corner_mesh.hpp"
#include "algo/picture_map.hpp"
#include "algo/seam_cost.hpp"
#include "algo/sight_table.hpp"
#include "algo/task_runner.hpp"
#include "algo/unit_geometry.hpp"
#include "algo/unit_seams.hpp"

namespace hitchview::algo {

/// From canvas pixels straight to camera pixels: calibration, placement, stabilisation, stitching
/// and seam in one map, known at the corners of blocks of block_px() x block_px() canvas pixels, to
/// be interpolated in between. So every output pixel is resampled once.
class ComposedMap {
 public:
    /// What one camera gives to one block corner.
    struct Corner {
        float x = 0;  ///< camera pixel
        float y = 0;
        float weight = 0;   ///< share in the output; 0: not used here
        bool sees = false;  ///< x, y are meaningful
    };

    /// Borrows `geometry`.
    ComposedMap(const Projection& canvas, const PerUnit<std::optional<UnitGeometry>>& geometry,
                const SeamOptions& seam);

    /// The map of one frame: every camera counts as present, the seams are straight.
    void Build(const Composition& composition, TaskRunner& runner);
    /// The same for given pictures: the seams go where the units agree, and a camera without a
    /// picture leaves its place to what else sees it, keeping a share too small to show elsewhere.
    void Build(const Composition& composition, const RigPictures& pictures, TaskRunner& runner);
    /// Afterwards: the same map with one unit alone, without seams (a view before blending).
    void SelectUnit(Unit unit);
    void SelectBoth();

    /// Even, and a multiple of PanoramaBlock::kSide.
    [[nodiscard]] int block_px() const { return whole_.spacing_px(); }
    [[nodiscard]] bool is_ring() const { return canvas_.IsRing(); }
    [[nodiscard]] int block_rows() const { return rows_ - 1; }
    [[nodiscard]] int block_cols() const { return cols_ - 1; }
    [[nodiscard]] int cameras() const { return static_cast<int>(sources_.size()); }
    [[nodiscard]] Unit unit_of(int source) const {
        return sources_[static_cast<std::size_t>(source)].unit;
    }
    [[nodiscard]] int camera_of(int source) const {
        return sources_[static_cast<std::size_t>(source)].camera;
    }
    [[nodiscard]] const Corner& corner(int source, int row, int col) const {
        return sources_[static_cast<std::size_t>(source)]
            .corners[static_cast<std::size_t>(row * cols_ + col)];
    }
    /// Columns of a row of corners outside which a source has no weight; none if last < first.
    struct Columns {
        int first = 0;
        int last = -1;
    };
    [[nodiscard]] const Columns& used(int source, int row) const {
        return sources_[static_cast<std::size_t>(source)].used[static_cast<std::size_t>(row)];
    }
    /// The part of the composition's detail that was used: all of it at the seams, none far away.
    /// Without corners if the composition has none.
    [[nodiscard]] const CornerField& shown_detail() const { return shown_detail_; }
    /// Column of the seam at a row of corners, canvas px.
    [[nodiscard]] double seam_px(Overlap overlap, int row) const {
        return seams_.path(overlap).x_px(row);
    }
    /// The same, on average over the rows.
    [[nodiscard]] PerOverlap<double> seam_px() const {
        return {{seams_.path(Overlap::kLeft).mean_px(), seams_.path(Overlap::kRight).mean_px()}};
    }

 private:
    using Shares = PixelRun::Of<float>;
    struct Source {
        void Replace(std::size_t row_at, const Columns& looked_at, const Columns& taken, int row);
        /// `shares`: what the units show of the columns.
        void Weight(int row, std::size_t row_at, const Columns& columns,
                    const PerUnit<Shares>& shares);

        Unit unit;
        int camera;  ///< of the unit
        std::vector<Corner> corners;
        std::vector<float> share;   ///< in the unit's view
        std::vector<Columns> seen;  ///< of each row; elsewhere the camera has no pixel
        std::vector<Columns> used;  ///< of each row
    };

    /// All that concerns one unit: where the canvas lies on its view, and its cameras there.
    struct UnitMap {
        UnitMap(const Projection& canvas, const UnitGeometry& unit_geometry);

        const UnitGeometry& geometry;
        PictureMap on_view;  ///< where the view is read, its offset included
        SightTable table;
    };

    void BuildFor(const Composition& composition, const RigPictures* pictures, TaskRunner& runner);
    void MeasureDiscrepancy(const Composition& composition, int row);
    /// For both units: where each reads these corners of a row, and its cameras there.
    void Locate(const Composition& composition, int row, const Columns& columns);
    void PlaceOnView(const UnitMap& unit, double moves, int row, int first_col,
                     PixelRun& view) const;
    void TakeSights(Unit unit, int row, int first_col, int count, SightRuns& sights);
    void TakeSights(Unit unit, std::size_t first, const CameraSightRun& sights, Shares& most);
    void FadeDetail(const Composition& composition, TaskRunner& runner);
    void LocateFadedRow(const Composition& composition, int row);
    void UpdateSeams(const Composition& composition, const RigPictures* pictures,
                     TaskRunner& runner);
    void CompareUnits(const Composition& composition, const RigPictures& pictures, int row);
    void FetchPatches(const RigPictures& pictures, std::size_t at) const;
    [[nodiscard]] bool SeenByBoth(std::size_t at) const {
        return covered_[Unit::kTractor][at] != 0 && covered_[Unit::kTrailer][at] != 0;
    }
    [[nodiscard]] const Corner& MainCorner(Unit unit, std::size_t at) const {
        return sources_[static_cast<std::size_t>(first_source_[unit] + main_camera_[unit][at])]
            .corners[at];
    }
    [[nodiscard]] GreyPatch PatchOf(const RigPictures& pictures, Unit unit, std::size_t at) const;
    [[nodiscard]] float DoubtAt(const Composition& composition, int row, int col) const;
    [[nodiscard]] float BendAt(const Composition& composition, int row, int col) const;
    void WeightRow(int row);
    void ShareBetweenUnits(int row, const Columns& columns, PerUnit<Shares>& shares) const;
    [[nodiscard]] std::size_t At(int row, int col) const {
        return static_cast<std::size_t>(row * cols_ + col);
    }

    Projection canvas_;
    CornerMesh canvas_mesh_;
    PerUnit<std::unique_ptr<UnitMap>> units_;
    CornerField coarse_;  // discrepancy without the detail
    CornerField whole_;   // discrepancy with the detail as it is shown
    int rows_;            // of corners
    int cols_;
    std::vector<Source> sources_;
    PerUnit<int> first_source_;
    UnitSeams seams_;
    SeamCost seam_cost_;
    CornerField shown_detail_;
    UnitSeams::Coverage covered_;
    PerUnit<std::vector<std::int8_t>> main_camera_;  ///< largest share; of covered corners
    PerUnit<CameraMask> present_;
    std::optional<Unit> selected_;
};

}  // namespace hitchview::algo
