#pragma once

#include <array>
#include <span>

#include "algo/mesh.hpp"
#include "algo/vertex_propagation.hpp"

namespace hitchview::algo {

struct FieldFitOptions {
    double smoothness = 0.1;      ///< of the membrane, against one sample
    double fade_px = 110;         ///< length over which a field without samples falls to 1 / e
    double memory = 0.5;          ///< weight of a fully supported vertex's prediction
    double change_px = 1e6;       ///< a prediction this far off counts a quarter
    double outlier_px = 2.0;      ///< samples this far off count a quarter
    double start_outlier_px = 8;  ///< likewise in the first solve
    int solves = 4;               ///< with new weights of the samples each
    int sweeps = 12;              ///< Gauss-Seidel, per solve
};

/// Fits a field on the mesh to motions known at scattered points: the minimum of
///     sum_k w_k |u(p_k) - d_k|^2 + memory sum_v w_v c_v |u_v - predicted_v|^2
///         + smoothness integral (|grad u|^2 + |u|^2 / fade^2, the latter where nothing is known)
/// with u bilinear in the cells. The weights w fall with the residual (Geman and McClure's weights)
/// and sharpen from solve to solve, so that single wrong motions have no say. Where nothing is
/// known the field is continued smoothly and fades out. No allocation; not thread-safe.
class FieldFit {
 public:
    FieldFit(const Mesh& mesh, const FieldFitOptions& options);

    /// `field`: where the search starts (a good guess: the prediction); then the result.
    /// `predicted`, `confidence` (0..1): what is known of each vertex before. `support` gets the
    /// weight of the samples round each vertex.
    void Fit(std::span<const PointMotion> samples, const VertexField& predicted,
             const VertexScalars& confidence, VertexField& field, VertexScalars& support);

 private:
    static constexpr int kNeighbours = 9;
    using Stencil = std::array<float, kNeighbours>;  // row by row; 4 is the vertex itself

    void Clear();
    void AddSamples(std::span<const PointMotion> samples, double outlier_px,
                    const VertexField& field);
    void AddSample(const PointMotion& sample, double outlier_px, const VertexField& field);
    void AddPrior(const VertexField& predicted, const VertexScalars& confidence,
                  const VertexField& field);
    void AddMembrane();
    void Sweep(VertexField& field) const;
    [[nodiscard]] int Neighbour(int row, int col, int k) const;
    [[nodiscard]] int Columns() const { return mesh_.ring ? Mesh::kCols : Mesh::kVertexCols; }

    Mesh mesh_;
    FieldFitOptions options_;
    std::array<Stencil, Mesh::kVertices> normal_{};
    VertexField right_ = VertexField::Zero();
    VertexScalars support_ = VertexScalars::Zero();
    std::array<std::array<int, kNeighbours>, Mesh::kVertices> neighbour_{};  // -1: none
};

}  // namespace hitchview::algo
