#include "algo/mesh.hpp"

namespace hitchview::algo {

void CloseRing(const Mesh& mesh, VertexField& field) {
    if (!mesh.ring) return;
    for (int row = 0; row < Mesh::kVertexRows; ++row) {
        field.col(Mesh::Index(row, Mesh::kCols)) = field.col(Mesh::Index(row, 0));
    }
}

}  // namespace hitchview::algo
