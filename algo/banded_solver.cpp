#include "algo/banded_solver.hpp"

#include <algorithm>
#include <cmath>

namespace hitchview::algo {

using Eigen::Index;

SymmetricBand::SymmetricBand(Index size, Index half_bandwidth)
    : lower_(Eigen::MatrixXd::Zero(half_bandwidth + 1, size)) {}

void SymmetricBand::AddDifference(Index i, Index j, double weight) {
    lower(i, i) += weight;
    lower(j, j) += weight;
    lower(std::max(i, j), std::min(i, j)) -= weight;
}

void SymmetricBand::AddDiagonal(const Eigen::Ref<const Eigen::VectorXd>& weight) {
    lower_.row(0) += weight.transpose();
}

BandedCholesky::BandedCholesky(const SymmetricBand& matrix) : L_(matrix) {
    for (Index i = 0; i < L_.size() && positive_definite_; ++i) positive_definite_ = FactorRow(i);
}

bool BandedCholesky::FactorRow(Index i) {
    const Index first = L_.FirstColumn(i);
    for (Index j = first; j <= i; ++j) {
        double rest = L_.lower(i, j);
        for (Index k = std::max(first, L_.FirstColumn(j)); k < j; ++k) {
            rest -= L_.lower(i, k) * L_.lower(j, k);
        }
        if (j < i) {
            L_.lower(i, j) = rest / L_.lower(j, j);
        } else if (rest > 0) {
            L_.lower(i, i) = std::sqrt(rest);
        } else {
            return false;
        }
    }
    return true;
}

void BandedCholesky::Substitute(Eigen::Ref<Eigen::VectorXd> x) const {
    for (Index i = 0; i < L_.size(); ++i) {
        for (Index j = L_.FirstColumn(i); j < i; ++j) x(i) -= L_.lower(i, j) * x(j);
        x(i) /= L_.lower(i, i);
    }
    for (Index i = L_.size() - 1; i >= 0; --i) {
        x(i) /= L_.lower(i, i);
        for (Index j = L_.FirstColumn(i); j < i; ++j) x(j) -= L_.lower(i, j) * x(i);
    }
}

Eigen::MatrixXd BandedCholesky::Solve(const Eigen::Ref<const Eigen::MatrixXd>& B) const {
    Eigen::MatrixXd X = B;
    for (Index column = 0; column < X.cols(); ++column) Substitute(X.col(column));
    return X;
}

}  // namespace hitchview::algo
