#include <gtest/gtest.h>

#include <Eigen/Cholesky>
#include <opencv2/core.hpp>
#include <tuple>

#include "algo/banded_solver.hpp"

namespace hitchview::algo {
namespace {

using Eigen::Index;
using Eigen::MatrixXd;

MatrixXd Dense(const SymmetricBand& band) {
    MatrixXd dense = MatrixXd::Zero(band.size(), band.size());
    for (Index i = 0; i < band.size(); ++i) {
        for (Index j = band.FirstColumn(i); j <= i; ++j)
            dense(i, j) = dense(j, i) = band.lower(i, j);
    }
    return dense;
}

/// Random differences with random weights, and a diagonal above zero.
SymmetricBand PositiveBand(Index size, Index half_bandwidth, cv::RNG& random) {
    SymmetricBand band(size, half_bandwidth);
    for (Index i = 0; i < size; ++i) {
        for (Index j = band.FirstColumn(i); j < i; ++j)
            band.AddDifference(i, j, random.uniform(0.0, 3.0));
    }
    Eigen::VectorXd diagonal(size);
    for (double& d : diagonal) d = random.uniform(0.1, 2.0);
    band.AddDiagonal(diagonal);
    return band;
}

class BandedCholeskyTest : public testing::TestWithParam<std::tuple<int, int>> {};

TEST_P(BandedCholeskyTest, SolvesWhatADenseSolverSolves) {
    const auto [size, half_bandwidth] = GetParam();
    cv::RNG random(5);
    const SymmetricBand band = PositiveBand(size, half_bandwidth, random);
    MatrixXd B(size, 7);
    for (double& b : B.reshaped()) b = random.uniform(-100.0, 100.0);
    const BandedCholesky sut(band);
    ASSERT_TRUE(sut.positive_definite());
    const MatrixXd expected = Dense(band).ldlt().solve(B);
    EXPECT_LT((sut.Solve(B) - expected).cwiseAbs().maxCoeff(), 1e-9);
}

INSTANTIATE_TEST_SUITE_P(Sizes, BandedCholeskyTest,
                         testing::Values(std::tuple{1, 0}, std::tuple{1, 10}, std::tuple{4, 10},
                                         std::tuple{11, 10}, std::tuple{40, 0}, std::tuple{40, 1},
                                         std::tuple{120, 10}, std::tuple{60, 21}));

TEST(SymmetricBandTest, ADifferenceAddsItsSquareToTheQuadraticForm) {
    SymmetricBand band(6, 3);
    band.AddDifference(4, 2, 2.5);
    band.AddDifference(1, 4, 0.5);
    const Eigen::VectorXd x = (Eigen::VectorXd(6) << 3, -1, 4, 1, -5, 9).finished();
    const double expected = 2.5 * std::pow(x(4) - x(2), 2) + 0.5 * std::pow(x(1) - x(4), 2);
    EXPECT_NEAR(x.dot(Dense(band) * x), expected, 1e-12);
}

TEST(BandedCholeskyTest, AMatrixThatIsNotPositiveDefiniteIsRefused) {
    SymmetricBand differences(20, 3);  // a constant costs nothing: the matrix is singular
    for (Index i = 1; i < 20; ++i) differences.AddDifference(i, i - 1, 1);
    differences.AddDiagonal(Eigen::VectorXd::Constant(20, -1e-6));
    EXPECT_FALSE(BandedCholesky(differences).positive_definite());
}

}  // namespace
}  // namespace hitchview::algo
