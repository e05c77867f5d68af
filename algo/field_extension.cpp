#include "algo/field_extension.hpp"

#include "algo/banded_solver.hpp"

namespace hitchview::algo {
namespace {

using Eigen::Index;
using Eigen::MatrixXd;
using Eigen::VectorXd;

/// Numbers the unknowns so that neighbours are near each other: down the columns, and on a ring the
/// columns from both ends in turn, so that the first and the last are neighbours too.
class Numbering {
 public:
    explicit Numbering(const Mesh& mesh)
        : ring_(mesh.ring), cols_(mesh.ring ? Mesh::kCols : Mesh::kVertexCols) {}

    [[nodiscard]] int cols() const { return cols_; }
    [[nodiscard]] Index size() const { return Index{cols_} * Mesh::kVertexRows; }
    [[nodiscard]] Index half_bandwidth() const { return Mesh::kVertexRows * (ring_ ? 2 : 1); }
    [[nodiscard]] bool HasRightNeighbour(int col) const { return ring_ || col + 1 < cols_; }
    [[nodiscard]] Index operator()(int row, int col) const {
        const int c = col % cols_;
        const int place = !ring_ ? c : c < cols_ / 2 ? 2 * c : 2 * (cols_ - 1 - c) + 1;
        return Index{place} * Mesh::kVertexRows + row;
    }

 private:
    bool ring_;
    int cols_;
};

void AddEdges(const Numbering& number, SymmetricBand& A) {
    for (int row = 0; row < Mesh::kVertexRows; ++row) {
        for (int col = 0; col < number.cols(); ++col) {
            const Index here = number(row, col);
            if (number.HasRightNeighbour(col)) A.AddDifference(here, number(row, col + 1), 1);
            if (row < Mesh::kRows) A.AddDifference(here, number(row + 1, col), 1);
        }
    }
}

}  // namespace

VertexField ExtendField(const Mesh& mesh, const VertexField& measured,
                        const VertexScalars& confidence, const FieldExtensionOptions& options) {
    const Numbering number(mesh);
    SymmetricBand A(number.size(), number.half_bandwidth());
    AddEdges(number, A);
    VectorXd pull(number.size());
    MatrixXd target(number.size(), 2);
    for (int row = 0; row < Mesh::kVertexRows; ++row) {
        for (int col = 0; col < number.cols(); ++col) {
            const int i = Mesh::Index(row, col);
            const double c = confidence(i);
            pull(number(row, col)) = options.support * c + options.fade * (1 - c);
            target.row(number(row, col)) =
                options.support * c * measured.col(i).cast<double>().transpose();
        }
    }
    A.AddDiagonal(pull);
    const MatrixXd found = BandedCholesky(A).Solve(target);
    VertexField field;
    for (int row = 0; row < Mesh::kVertexRows; ++row) {
        for (int col = 0; col < Mesh::kVertexCols; ++col)
            field.col(Mesh::Index(row, col)) =
                found.row(number(row, col)).transpose().cast<float>();
    }
    return field;
}

}  // namespace hitchview::algo
