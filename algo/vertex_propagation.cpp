#include "algo/vertex_propagation.hpp"

#include <algorithm>
#include <cmath>

#include "algo/fixed_vector.hpp"

namespace hitchview::algo {
namespace {

using Eigen::Vector2d;
using Eigen::Vector2f;

/// A vertex hears at most this many points: the median of more is not better.
constexpr std::size_t kMaxVotes = 48;
using Votes = FixedVector<float, kMaxVotes>;

float Median(Votes& votes) {
    const auto middle = votes.begin() + votes.count() / 2;
    std::nth_element(votes.begin(), middle, votes.end());
    if (votes.count() % 2 != 0) return *middle;
    return 0.5F * (*middle + *std::max_element(votes.begin(), middle));
}

Vector2f Vote(const Mesh& mesh, const Vector2d& vertex, std::span<const PointMotion> points,
              const PropagationOptions& options, int& count) {
    Votes x;
    Votes y;
    for (const PointMotion& point : points) {
        Vector2d d = point.at_px - vertex;
        if (mesh.ring) d.x() -= mesh.width_px * std::round(d.x() / mesh.width_px);
        if (d.cwiseQuotient(options.radius_px).squaredNorm() > 1) continue;
        if (!x.push_back(static_cast<float>(point.motion_px.x()))) break;
        y.push_back(static_cast<float>(point.motion_px.y()));
    }
    count = x.count();
    if (count < options.min_votes) return Vector2f::Zero();
    const auto shrink = static_cast<float>(count / (count + options.shrink_votes));
    return shrink * Vector2f{Median(x), Median(y)};
}

/// Median of the nine vertices around each one; the edge of the mesh counts its nearest ones again.
void MedianFilter(const Mesh& mesh, const VertexField& raw, VertexField& filtered) {
    std::array<std::array<float, 9>, 2> window{};
    for (int row = 0; row < Mesh::kVertexRows; ++row) {
        for (int col = 0; col < Mesh::kVertexCols; ++col) {
            std::size_t n = 0;
            for (int r = row - 1; r <= row + 1; ++r) {
                for (int c = col - 1; c <= col + 1; ++c, ++n) {
                    const int rr = std::clamp(r, 0, Mesh::kRows);
                    const int cc = std::clamp(mesh.WrappedColumn(c), 0, Mesh::kCols);
                    window[0][n] = raw(0, Mesh::Index(rr, cc));
                    window[1][n] = raw(1, Mesh::Index(rr, cc));
                }
            }
            for (int axis = 0; axis < 2; ++axis) {
                auto& w = window[static_cast<std::size_t>(axis)];
                std::nth_element(w.begin(), w.begin() + 4, w.end());
                filtered(axis, Mesh::Index(row, col)) = w[4];
            }
        }
    }
}

}  // namespace

void PropagateToVertices(const Mesh& mesh, std::span<const PointMotion> points,
                         const PropagationOptions& options, VertexField& field,
                         VertexScalars* votes) {
    VertexField raw;
    for (int row = 0; row < Mesh::kVertexRows; ++row) {
        for (int col = 0; col < Mesh::kVertexCols; ++col) {
            const int i = Mesh::Index(row, col);
            int count = 0;
            raw.col(i) = Vote(mesh, mesh.Vertex(row, col), points, options, count);
            if (votes != nullptr) (*votes)(i) = static_cast<float>(count);
        }
    }
    MedianFilter(mesh, raw, field);
    CloseRing(mesh, field);
}

}  // namespace hitchview::algo
