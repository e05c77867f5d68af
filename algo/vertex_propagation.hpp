#pragma once

#include <Eigen/Core>
#include <span>

#include "algo/mesh.hpp"

namespace hitchview::algo {

/// A motion known at one point of a picture.
struct PointMotion {
    Eigen::Vector2d at_px;
    Eigen::Vector2d motion_px;
};

struct PropagationOptions {
    Eigen::Vector2d radius_px{80, 80};  ///< semi-axes of the ellipse around a vertex
    int min_votes = 3;
    double shrink_votes = 3;  ///< n votes count as n / (n + shrink_votes)
};

/// Motion of the vertices from the motions of points (paper eq. 'vertex residual'): the median, per
/// axis, of the motions inside the ellipse around each vertex, shrunk towards zero where votes are
/// few, and then the 3x3 median over the mesh, per axis. `votes` (optional) gets the number of
/// points that each vertex heard. The paper's Gaussian sum is a median here because a mover or a
/// near thing must not pull the background along.
void PropagateToVertices(const Mesh& mesh, std::span<const PointMotion> points,
                         const PropagationOptions& options, VertexField& field,
                         VertexScalars* votes = nullptr);

}  // namespace hitchview::algo
