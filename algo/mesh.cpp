#include "algo/mesh.hpp"

#include <algorithm>

namespace hitchview::algo {

using Eigen::Vector2d;
using Eigen::Vector2f;

MeshPlace Locate(const Mesh& mesh, const Vector2d& pixel) {
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

Vector2d Sample(const Mesh& mesh, const VertexField& field, const Vector2d& pixel) {
    const MeshPlace place = Locate(mesh, pixel);
    Vector2f sum = Vector2f::Zero();
    for (std::size_t k = 0; k < 4; ++k) sum += place.share[k] * field.col(place.vertex[k]);
    return sum.cast<double>();
}

void CloseRing(const Mesh& mesh, VertexField& field) {
    if (!mesh.ring) return;
    for (int row = 0; row < Mesh::kVertexRows; ++row) {
        field.col(Mesh::Index(row, Mesh::kCols)) = field.col(Mesh::Index(row, 0));
    }
}

}  // namespace hitchview::algo
