#include "app/truth_field.hpp"

#include <Eigen/Dense>
#include <array>

namespace hitchview::app {
namespace {

using algo::Mesh;
using Eigen::MatrixXd;

/// Keeps vertices without any sample anywhere near determined.
constexpr double kRidge = 1e-6;

/// Vertices are unknowns; on a ring the last column is the first.
struct Unknowns {
    explicit Unknowns(const Mesh& mesh)
        : cols(mesh.ring ? Mesh::kCols : Mesh::kVertexCols), count(Mesh::kVertexRows * cols) {}
    [[nodiscard]] int At(int row, int col) const { return row * cols + col % cols; }
    [[nodiscard]] int Of(int vertex) const {
        return At(vertex / Mesh::kVertexCols, vertex % Mesh::kVertexCols);
    }

    int cols;
    int count;
};

/// A bilinear sample: four vertices and their weights.
struct Corners {
    std::array<int, 4> unknown;
    std::array<double, 4> weight;
};

Corners CornersOf(const Mesh& mesh, const Unknowns& unknowns, const Eigen::Vector2d& pixel) {
    const algo::MeshPlace place = algo::Locate(mesh, pixel);
    Corners corners;
    for (std::size_t i = 0; i < 4; ++i) {
        corners.unknown[i] = unknowns.Of(place.vertex[i]);
        corners.weight[i] = double{place.share[i]};
    }
    return corners;
}

class NormalEquations {
 public:
    explicit NormalEquations(int count)
        : left_(MatrixXd::Identity(count, count) * kRidge), right_(MatrixXd::Zero(count, 2)) {}

    void AddSample(const Corners& at, const Eigen::Vector2d& motion_px) {
        for (std::size_t i = 0; i < 4; ++i) {
            for (std::size_t j = 0; j < 4; ++j)
                left_(at.unknown[i], at.unknown[j]) += at.weight[i] * at.weight[j];
            right_.row(at.unknown[i]) += at.weight[i] * motion_px.transpose();
        }
    }

    void AddNeighbours(int a, int b, double smoothness) {
        left_(a, a) += smoothness;
        left_(b, b) += smoothness;
        left_(a, b) -= smoothness;
        left_(b, a) -= smoothness;
    }

    [[nodiscard]] MatrixXd Solve() const { return left_.ldlt().solve(right_); }

 private:
    MatrixXd left_;
    MatrixXd right_;
};

}  // namespace

algo::VertexField FitField(const Mesh& mesh, std::span<const FieldSample> samples,
                           double smoothness) {
    const Unknowns unknowns(mesh);
    NormalEquations equations(unknowns.count);
    for (const FieldSample& sample : samples)
        equations.AddSample(CornersOf(mesh, unknowns, sample.pixel), sample.motion_px);
    for (int row = 0; row < Mesh::kVertexRows; ++row) {
        for (int col = 0; col < Mesh::kCols; ++col)
            equations.AddNeighbours(unknowns.At(row, col), unknowns.At(row, col + 1), smoothness);
    }
    for (int row = 0; row < Mesh::kRows; ++row) {
        for (int col = 0; col < unknowns.cols; ++col)
            equations.AddNeighbours(unknowns.At(row, col), unknowns.At(row + 1, col), smoothness);
    }
    const MatrixXd solution = equations.Solve();
    algo::VertexField field;
    for (int row = 0; row < Mesh::kVertexRows; ++row) {
        for (int col = 0; col < Mesh::kVertexCols; ++col)
            field.col(Mesh::Index(row, col)) =
                solution.row(unknowns.At(row, col)).transpose().cast<float>();
    }
    return field;
}

}  // namespace hitchview::app
