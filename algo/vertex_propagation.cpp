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

/// What one vertex has heard.
struct Ballot {
    Votes x;
    Votes y;
};
using ColumnBallots = std::array<Ballot, Mesh::kVertexRows>;

double Square(double x) {
    return x * x;
}

/// Each point is heard in turn by the vertices of a column whose ellipse it lies in. A point too
/// far beside the column is far from all of them.
void HearColumn(const Mesh& mesh, int col, std::span<const PointMotion> points,
                const Vector2d& radius_px, ColumnBallots& ballots) {
    for (Ballot& ballot : ballots) {
        ballot.x.clear();
        ballot.y.clear();
    }
    const Vector2d top = mesh.Vertex(0, col);
    for (const PointMotion& point : points) {
        double dx = point.at_px.x() - top.x();
        if (mesh.ring && std::abs(dx) >= 0.5 * mesh.width_px) {
            dx -= mesh.width_px * std::round(dx / mesh.width_px);
        }
        const double across = Square(dx / radius_px.x());
        if (across > 1) continue;
        for (std::size_t row = 0; row < ballots.size(); ++row) {
            const double dy =
                point.at_px.y() - (top.y() + static_cast<double>(row) * mesh.cell_px.y());
            if (across + Square(dy / radius_px.y()) > 1) continue;
            if (ballots[row].x.push_back(static_cast<float>(point.motion_px.x()))) {
                ballots[row].y.push_back(static_cast<float>(point.motion_px.y()));
            }
        }
    }
}

Vector2f Count(Ballot& ballot, const PropagationOptions& options) {
    const int count = ballot.x.count();
    if (count < options.min_votes) return Vector2f::Zero();
    const auto shrink = static_cast<float>(count / (count + options.shrink_votes));
    return shrink * Vector2f{Median(ballot.x), Median(ballot.y)};
}

void Order(float& a, float& b) {
    const float smaller = std::min(a, b);
    b = std::max(a, b);
    a = smaller;
}

/// Of a 3 x 3 square sorted along its rows and then its columns, the median is that of the rising
/// diagonal.
float MedianOfNine(std::array<float, 9>& v) {
    const auto sort = [&](std::size_t a, std::size_t b, std::size_t c) {
        Order(v[a], v[b]);
        Order(v[b], v[c]);
        Order(v[a], v[b]);
    };
    for (const std::size_t i : {0, 3, 6}) sort(i, i + 1, i + 2);
    for (const std::size_t i : {0, 1, 2}) sort(i, i + 3, i + 6);
    sort(2, 4, 6);
    return v[4];
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
                filtered(axis, Mesh::Index(row, col)) =
                    MedianOfNine(window[static_cast<std::size_t>(axis)]);
            }
        }
    }
}

}  // namespace

void PropagateToVertices(const Mesh& mesh, std::span<const PointMotion> points,
                         const PropagationOptions& options, VertexField& field,
                         VertexScalars* votes) {
    VertexField raw;
    ColumnBallots ballots;
    for (int col = 0; col < Mesh::kVertexCols; ++col) {
        HearColumn(mesh, col, points, options.radius_px, ballots);
        for (int row = 0; row < Mesh::kVertexRows; ++row) {
            Ballot& ballot = ballots[static_cast<std::size_t>(row)];
            const int i = Mesh::Index(row, col);
            if (votes != nullptr) (*votes)(i) = static_cast<float>(ballot.x.count());
            raw.col(i) = Count(ballot, options);
        }
    }
    MedianFilter(mesh, raw, field);
    CloseRing(mesh, field);
}

}  // namespace hitchview::algo
