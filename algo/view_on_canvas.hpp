#pragma once

#include <Eigen/Core>
#include <vector>

#include "algo/projection.hpp"

namespace hitchview::algo {

/// Where the pixels of one unit's view lie on the canvas: exact at the nodes of a grid over the
/// view, bilinear between them (to about 0.01 px while the canvas is tilted by less than 6
/// degrees). Memory is taken at construction.
class ViewOnCanvas {
 public:
    ViewOnCanvas(const Projection& view, const Projection& canvas);

    /// `M_canvas_view` takes rays of the view to the canvas.
    void Update(const Eigen::Matrix3d& M_canvas_view);

    /// Canvas px; on a ring x may be off by whole turns. Outside the view: extrapolated.
    [[nodiscard]] Eigen::Vector2d At(const Eigen::Vector2d& view_px) const;

 private:
    static constexpr int kPitch_px = 16;

    [[nodiscard]] Eigen::Vector2d& Node(int row, int col) {
        return nodes_[static_cast<std::size_t>(row * cols_ + col)];
    }

    Projection view_;
    Projection canvas_;
    int rows_;
    int cols_;
    std::vector<Eigen::Vector2d> nodes_;  // canvas px, without a jump at the canvas's edge
};

}  // namespace hitchview::algo
