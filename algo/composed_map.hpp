#pragma once

#include <vector>

#include "algo/stitching_motion_field.hpp"
#include "algo/task_runner.hpp"
#include "algo/unified_vertex_motion.hpp"
#include "algo/unit_geometry.hpp"

namespace hitchview::algo {

struct SeamOptions {
    double half_width_px = 12;    ///< of the feathered strip
    double tracking_gain = 0.08;  ///< share of the way to the middle of the overlap, per frame
};

/// From canvas pixels straight to camera pixels: calibration, placement, stabilisation, stitching
/// and seam in one map, exact at the corners of blocks of kBlock x kBlock canvas pixels, to be
/// interpolated in between. So every output pixel is resampled once.
class ComposedMap {
 public:
    static constexpr int kBlock = 8;  ///< canvas px, even

    /// What one camera gives to one block corner.
    struct Corner {
        float x = 0;  ///< camera pixel
        float y = 0;
        float weight = 0;   ///< share in the output; 0: not used here
        bool sees = false;  ///< x, y are meaningful
    };

    ComposedMap(const Projection& canvas, const PerUnit<std::optional<UnitGeometry>>& geometry,
                const SeamOptions& seam);

    /// The map of one frame. `only`: that unit alone, without seams (a view before blending).
    void Build(const Composition& composition, TaskRunner& runner);
    /// Afterwards: the same map with one unit alone.
    void SelectUnit(Unit unit);
    void SelectBoth();

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
    /// Column of the seam, canvas px.
    [[nodiscard]] const PerOverlap<double>& seam_px() const { return seam_px_; }

 private:
    struct Source {
        Unit unit;
        int camera;  ///< of the unit
        std::vector<Corner> corners;
        std::vector<float> share;  ///< in the unit's view
    };

    void LocateRow(const Composition& composition, int row);
    void LocateCorner(const Composition& composition, Unit unit, int row, int col);
    void UpdateSeams(const Composition& composition);
    void SetSeam(Overlap overlap, double target, bool known);
    [[nodiscard]] double MiddleOfOverlap(int from_col, int to_col, bool& known) const;
    void WeightRow(int row);
    [[nodiscard]] double TractorShare(double x) const;
    [[nodiscard]] Eigen::Vector2d CornerPixel(int row, int col) const {
        return {col * double{kBlock} - 0.5, row * double{kBlock} - 0.5};
    }
    [[nodiscard]] std::size_t At(int row, int col) const {
        return static_cast<std::size_t>(row * cols_ + col);
    }

    Projection canvas_;
    Mesh canvas_mesh_;
    const PerUnit<std::optional<UnitGeometry>>* geometry_;
    SeamOptions seam_;
    int rows_;  // of corners
    int cols_;
    std::vector<Source> sources_;
    PerUnit<int> first_source_;
    PerUnit<std::vector<std::uint8_t>> covered_;  // by the unit, per corner
    PerUnit<Eigen::Matrix3d> M_view_canvas_;
    PerOverlap<double> seam_px_;
    PerOverlap<bool> seam_known_{{false, false}};
    bool trailer_left_ = false;  // plane: the trailer lies to the left of the tractor
    std::optional<Unit> selected_;
};

}  // namespace hitchview::algo
