#pragma once

#include "algo/mesh.hpp"

namespace hitchview::algo {

struct FieldExtensionOptions {
    double support = 30;  ///< pull of a fully supported vertex to its measured value
    double fade = 0.35;   ///< pull of an unsupported vertex to zero
};

/// Continues a field that was measured in the overlap alone over the whole mesh: the minimum of
///     sum over edges |u_a - u_b|^2 + sum over vertices support c |u - measured|^2 + fade (1 - c)
///     |u|^2
/// with c = `confidence`, 0..1, of each vertex. So it follows what was measured, is smooth, and
/// fades to zero within a few cells. On a ring the first column is the neighbour of the last.
VertexField ExtendField(const Mesh& mesh, const VertexField& measured,
                        const VertexScalars& confidence, const FieldExtensionOptions& options = {});

}  // namespace hitchview::algo
