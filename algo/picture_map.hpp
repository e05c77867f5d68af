#pragma once

#include <Eigen/Core>
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
    [[nodiscard]] Eigen::Vector2d At(const Eigen::Vector2d& pixel) const;

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
    std::vector<Eigen::Vector2d> nodes_;  // px, without a jump at the other picture's edge
};

}  // namespace hitchview::algo
