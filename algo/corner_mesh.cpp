#include "algo/corner_mesh.hpp"

namespace hitchview::algo {

using Eigen::Vector2f;

CornerMesh::CornerMesh(const Projection& canvas) {
    const Mesh mesh(canvas);
    const CornerScalars grid(canvas, 0);
    for (int row = 0; row < grid.rows(); ++row) {
        const MeshPlace place = Locate(mesh, grid.Pixel(row, 0));
        rows_.push_back({place.vertex[0] / Mesh::kVertexCols, place.share[2] + place.share[3]});
    }
    for (int col = 0; col < grid.cols(); ++col) {
        const MeshPlace place = Locate(mesh, grid.Pixel(0, col));
        cols_.push_back({place.vertex[0] % Mesh::kVertexCols, place.share[1] + place.share[3]});
    }
}

void CornerMesh::SampleRow(const VertexField& field, int row, CornerField& at_corners) const {
    const Place& down = rows_[static_cast<std::size_t>(row)];
    std::array<Vector2f, Mesh::kVertexCols> mixed;
    for (int col = 0; col < Mesh::kVertexCols; ++col) {
        const Vector2f upper = field.col(Mesh::Index(down.first, col));
        const Vector2f lower = field.col(Mesh::Index(down.first + 1, col));
        mixed[static_cast<std::size_t>(col)] = upper + down.share * (lower - upper);
    }
    for (int col = 0; col < at_corners.cols(); ++col) {
        const Place& across = cols_[static_cast<std::size_t>(col)];
        const Vector2f* left = mixed.data() + across.first;
        at_corners.at(row, col) = left[0] + across.share * (left[1] - left[0]);
    }
}

}  // namespace hitchview::algo
