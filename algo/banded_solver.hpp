#pragma once

#include <Eigen/Core>

namespace hitchview::algo {

/// A symmetric matrix with nothing farther than `half_bandwidth` from the diagonal. Only the lower
/// half is stored: element (i, j), j <= i, at lower(i - j, i).
class SymmetricBand {
 public:
    /// size x size, all zero. size >= 1, half_bandwidth >= 0.
    SymmetricBand(Eigen::Index size, Eigen::Index half_bandwidth);

    [[nodiscard]] Eigen::Index size() const { return lower_.cols(); }
    [[nodiscard]] Eigen::Index half_bandwidth() const { return lower_.rows() - 1; }
    /// i - half_bandwidth <= j <= i.
    [[nodiscard]] double& lower(Eigen::Index i, Eigen::Index j) { return lower_(i - j, i); }
    [[nodiscard]] double lower(Eigen::Index i, Eigen::Index j) const { return lower_(i - j, i); }
    /// First column of row i that lies in the band.
    [[nodiscard]] Eigen::Index FirstColumn(Eigen::Index i) const {
        return i > half_bandwidth() ? i - half_bandwidth() : 0;
    }

    /// Adds weight * (x_i - x_j)^2 to the quadratic form x' A x. i != j, both within the band.
    void AddDifference(Eigen::Index i, Eigen::Index j, double weight);
    /// Adds weight(i) * x_i^2 for every i.
    void AddDiagonal(const Eigen::Ref<const Eigen::VectorXd>& weight);

 private:
    Eigen::MatrixXd lower_;  // (half_bandwidth + 1) x size
};

/// Cholesky factor L of a symmetric positive definite band, A = L L': it keeps the band. Factored
/// once, size * half_bandwidth^2 steps; each right-hand side costs size * half_bandwidth * 2 more.
class BandedCholesky {
 public:
    explicit BandedCholesky(const SymmetricBand& matrix);

    /// False: the matrix was not positive definite, and nothing may be solved.
    [[nodiscard]] bool positive_definite() const { return positive_definite_; }

    /// X with A X = B; every column of B is one right-hand side of `size` rows.
    [[nodiscard]] Eigen::MatrixXd Solve(const Eigen::Ref<const Eigen::MatrixXd>& B) const;

 private:
    bool FactorRow(Eigen::Index i);
    void Substitute(Eigen::Ref<Eigen::VectorXd> x) const;

    SymmetricBand L_;
    bool positive_definite_ = true;
};

}  // namespace hitchview::algo
