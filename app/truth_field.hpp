#pragma once

#include <span>

#include "algo/mesh.hpp"

namespace hitchview::app {

/// A motion known at one place.
struct FieldSample {
    Eigen::Vector2d pixel;
    Eigen::Vector2d motion_px;
};

/// The field of the mesh that comes nearest to the samples: least squares of the bilinear field at
/// the samples, and `smoothness` times the squared difference between neighbouring vertices
/// (Tikhonov). What an estimator with perfect knowledge could do with this mesh.
algo::VertexField FitField(const algo::Mesh& mesh, std::span<const FieldSample> samples,
                           double smoothness);

}  // namespace hitchview::app
