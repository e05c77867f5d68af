#pragma once

#include "algo/mesh.hpp"

namespace hitchview::algo {

/// Largest change of a field per cell that GuardFolds leaves, in cells. A map that reads at c + s
/// u(c), |s| <= 1, then has a Jacobian determinant of at least (1 - .4)^2 - .4^2 = .2: nothing
/// folds.
inline constexpr double kMaxStretch = 0.4;

/// Eases edges of the mesh along which `field` (px) changes by more than `max_stretch` of the edge,
/// each axis for itself; what easing leaves scales the whole field. A field that is within the
/// limit stays as it is. Takes no memory.
void GuardFolds(const Mesh& mesh, double max_stretch, VertexField& field);

}  // namespace hitchview::algo
