#pragma once

#include <Eigen/Core>
#include <cstdint>
#include <vector>

#include "algo/composed_map.hpp"
#include "app/rig_geometry.hpp"

namespace hitchview::app {

/// A map from a regular grid on the canvas to where the same ray lies when nothing moves (the
/// unit's view on its own cylinder), so the motion that one unit's part of the picture was given.
struct WarpGrid {
    int rows = 0;
    int cols = 0;
    double spacing_px = 1;
    std::vector<Eigen::Vector2d> motion_px;  ///< to - from; row after row
    std::vector<std::uint8_t> known;         ///< the unit has data there

    WarpGrid() = default;
    WarpGrid(int row_count, int col_count, double spacing);

    [[nodiscard]] std::size_t At(int row, int col) const {
        return static_cast<std::size_t>(row * cols + col);
    }
    /// All four corners of the cell are known.
    [[nodiscard]] bool HasCell(int row, int col) const;
};

/// True where a camera of the unit shows something at a corner of the map: inside its picture.
/// `missing`: bit i is camera i of the rig, tractor first, that gave no picture.
bool HasData(const algo::ComposedMap& map, const RigGeometry& geometry, algo::Unit unit, int row,
             int col, std::uint32_t missing = 0);

/// True where a camera of any unit shows something and has a share in the picture.
bool IsRendered(const algo::ComposedMap& map, const RigGeometry& geometry, int row, int col,
                std::uint32_t missing);

/// From the corners of the rendered map, every `step`-th.
WarpGrid WarpOf(const algo::ComposedMap& map, const RigGeometry& geometry, algo::Unit unit,
                int step);

/// What is left of the motion beside the one turn of the whole vehicle that explains it best: a
/// turned camera bends its part of a ring and yet distorts nothing. Below three known corners: as
/// it is.
WarpGrid WithoutTurn(const WarpGrid& warp, const algo::Projection& canvas);

/// Cells of which one of both triangles is turned over or has no area.
int FoldedCells(const WarpGrid& warp);

/// Smallest ratio of the two stretches (singular values of the Jacobian, 1: a similarity) of the
/// cells that are known in `warp` and not in `other`. 1 without such a cell.
double LeastCellRatio(const WarpGrid& warp, const WarpGrid& other);

/// The same ratio of the one affine map that fits all known corners best. 1 below three corners.
double AffineRatio(const WarpGrid& warp);

}  // namespace hitchview::app
