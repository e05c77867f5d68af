#pragma once

#include <Eigen/Core>
#include <algorithm>
#include <array>

#include "algo/projection.hpp"

namespace hitchview::algo {

/// A regular grid of vertices over a picture; cell corners lie on the picture's outer pixels.
/// On a ring the last column of vertices is the first one again.
struct Mesh {
    static constexpr int kRows = 10;  ///< cells
    static constexpr int kCols = 32;
    static constexpr int kVertexRows = kRows + 1;
    static constexpr int kVertexCols = kCols + 1;
    static constexpr int kVertices = kVertexRows * kVertexCols;

    explicit Mesh(const Projection& picture)
        : ring(picture.IsRing()),
          width_px(picture.width_px),
          cell_px((ring ? picture.width_px : picture.width_px - 1) / double{kCols},
                  (picture.height_px - 1) / double{kRows}),
          origin_px(ring ? -0.5 : 0.0, 0.0) {}

    static constexpr int Index(int row, int col) { return row * kVertexCols + col; }
    /// On a ring the same column of vertices, counted from the first; else `col` itself. From
    /// -kCols.
    [[nodiscard]] int WrappedColumn(int col) const { return ring ? (col + kCols) % kCols : col; }
    [[nodiscard]] Eigen::Vector2d Vertex(int row, int col) const {
        return origin_px + Eigen::Vector2d{col * cell_px.x(), row * cell_px.y()};
    }

    bool ring;
    double width_px;
    Eigen::Vector2d cell_px;
    Eigen::Vector2d origin_px;
};

/// Motion of every vertex, px; column Mesh::Index(row, col).
using VertexField = Eigen::Matrix<float, 2, Mesh::kVertices>;
/// One number for every vertex.
using VertexScalars = Eigen::Matrix<float, 1, Mesh::kVertices>;

/// The cell that a pixel lies in: its corners (top left, top right, bottom left, bottom right) and
/// their bilinear shares.
struct MeshPlace {
    std::array<int, 4> vertex;
    std::array<float, 4> share;
};
/// Outside the mesh: the nearest place on its edge.
inline MeshPlace Locate(const Mesh& mesh, const Eigen::Vector2d& pixel) {
    const double x = mesh.ring ? WrapColumn(pixel.x(), mesh.width_px) : pixel.x();
    const double u =
        std::clamp((x - mesh.origin_px.x()) / mesh.cell_px.x(), 0.0, Mesh::kCols - 1e-6);
    const double v =
        std::clamp((pixel.y() - mesh.origin_px.y()) / mesh.cell_px.y(), 0.0, Mesh::kRows - 1e-6);
    const int col = static_cast<int>(u);
    const int row = static_cast<int>(v);
    const auto fx = static_cast<float>(u - col);
    const auto fy = static_cast<float>(v - row);
    const int i = Mesh::Index(row, col);
    const int below = i + Mesh::kVertexCols;
    return {{i, i + 1, below, below + 1},
            {(1 - fx) * (1 - fy), fx * (1 - fy), (1 - fx) * fy, fx * fy}};
}

/// The vertex of a ring's first column if `vertex` is the same one in the last column.
inline int FirstColumnOfRing(int vertex) {
    return vertex % Mesh::kVertexCols == Mesh::kCols ? vertex - Mesh::kCols : vertex;
}

/// `field` at `pixel`, bilinear; outside the mesh the nearest edge's value.
inline Eigen::Vector2d Sample(const Mesh& mesh, const VertexField& field,
                              const Eigen::Vector2d& pixel) {
    const MeshPlace place = Locate(mesh, pixel);
    Eigen::Vector2f sum = Eigen::Vector2f::Zero();
    for (std::size_t k = 0; k < 4; ++k) sum += place.share[k] * field.col(place.vertex[k]);
    return sum.cast<double>();
}

/// On a ring: makes the last column equal to the first.
void CloseRing(const Mesh& mesh, VertexField& field);

}  // namespace hitchview::algo
