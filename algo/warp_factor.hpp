#pragma once

#include <Eigen/Core>

#include "algo/mesh.hpp"
#include "algo/projection.hpp"

namespace hitchview::algo {

/// A warp of a view as the renderer draws it: what is read at view pixel y - rest(y) is shown where
/// `pose` puts y.
struct FactoredWarp {
    Eigen::Matrix3d pose = Eigen::Matrix3d::Identity();
    VertexField rest = VertexField::Zero();
};

/// Splits `warp`, which shows view pixel v at v + warp(v), into the pose that fits it best at the
/// vertices (a similarity on a plane, a rotation on a ring) and the rest. Exact at the vertices
/// that the rest puts somewhere, for warps that do not fold.
FactoredWarp FactorWarp(const Projection& view, const VertexField& warp);

}  // namespace hitchview::algo
