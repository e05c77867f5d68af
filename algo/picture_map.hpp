#pragma once

#include <Eigen/Core>
#include <algorithm>
#include <vector>

#include "algo/mesh.hpp"
#include "algo/projection.hpp"
#include "algo/task_runner.hpp"

namespace hitchview::algo {

/// Where the pixels of one picture lie on another (view and canvas, either way): exact at the nodes
/// of a grid, bilinear between them (to about 0.01 px while one is tilted against the other by less
/// than 6 degrees). Memory is taken at construction.
class PictureMap {
 public:
    PictureMap(const Projection& from, const Projection& to);

    /// `M_to_from` takes rays of the one picture to the other.
    void Update(const Eigen::Matrix3d& M_to_from, TaskRunner& runner);
    /// The same, less `offset`, a field on the other picture, where a pixel lies.
    void Update(const Eigen::Matrix3d& M_to_from, const VertexField& offset, TaskRunner& runner);

    /// Pixel of the other picture; on a ring x may be off by whole turns. Outside the first one:
    /// extrapolated.
    [[nodiscard]] Eigen::Vector2d At(const Eigen::Vector2d& pixel) const {
        using Pair = Eigen::Array4f;  // a node and the one right of it
        const double u = pixel.x() * nodes_per_px_;
        const double v = pixel.y() * nodes_per_px_;
        const int col = std::clamp(static_cast<int>(u), 0, cols_ - 2);
        const int row = std::clamp(static_cast<int>(v), 0, rows_ - 2);
        const auto s = static_cast<float>(u - col);
        const auto t = static_cast<float>(v - row);
        const float* top = nodes_[Index(row, col)].data();
        const Pair above = Eigen::Map<const Pair>(top);
        const Pair mixed = above + t * (Eigen::Map<const Pair>(top + 2 * cols_) - above);
        return (mixed.head<2>() + s * (mixed.tail<2>() - mixed.head<2>())).matrix().cast<double>();
    }

 private:
    void PlaceRow(const Eigen::Matrix3d& M_to_from, const VertexField* offset, int row);
    void Unwrap();
    void UpdateWith(const Eigen::Matrix3d& M_to_from, const VertexField* offset,
                    TaskRunner& runner);
    [[nodiscard]] std::size_t Index(int row, int col) const {
        return static_cast<std::size_t>(row * cols_ + col);
    }

    Projection to_;
    Mesh to_mesh_;
    int pitch_px_;
    double nodes_per_px_;
    int rows_;
    int cols_;
    std::vector<Eigen::Vector3d> rays_;
    std::vector<Eigen::Vector2f> nodes_;  // px, without a jump at the other picture's edge
};

}  // namespace hitchview::algo
