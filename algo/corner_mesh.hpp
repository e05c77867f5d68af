#pragma once

#include <vector>

#include "algo/corner_grid.hpp"
#include "algo/mesh.hpp"

namespace hitchview::algo {

/// Reads fields on the mesh of a canvas at the corners of its CornerGrid: as Sample does, from
/// shares that are worked out once. Memory is taken at construction; thread-safe afterwards.
class CornerMesh {
 public:
    explicit CornerMesh(const Projection& canvas);

    /// Row `row` of `at_corners`, a grid of the same canvas.
    void SampleRow(const VertexField& field, int row, CornerField& at_corners) const;

 private:
    /// Between two vertices of a row or a column.
    struct Place {
        int first;
        float share;  ///< of the second
    };

    std::vector<Place> rows_;
    std::vector<Place> cols_;
};

}  // namespace hitchview::algo
