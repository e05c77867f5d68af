#pragma once

#include <ceres/ceres.h>

#include <Eigen/Core>
#include <optional>
#include <vector>

namespace hitchview::calib {

/// What some of a problem's errors say about some of its unknowns.
struct NormalEquations {
    Eigen::MatrixXd matrix{};    ///< J^T J
    Eigen::VectorXd gradient{};  ///< J^T r
    double squared_errors = 0;
    double rows = 0;  ///< errors, counted singly

    /// Of `blocks` at the present values, with robust loss where they have one. `unknowns`:
    /// parameter blocks in the order of the matrix; those that are not part of the problem or
    /// constant give zeros.
    static NormalEquations Of(ceres::Problem& problem,
                              const std::vector<ceres::ResidualBlockId>& blocks,
                              const std::vector<double*>& unknowns);
    /// The same where the last parameter of each error is an unknown of one number that no other
    /// error has: it is eliminated.
    static NormalEquations WithoutLast(ceres::Problem& problem,
                                       const std::vector<ceres::ResidualBlockId>& blocks,
                                       const std::vector<double*>& unknowns);

    /// Errors that the unknowns do not take up. `covariance`: inverse of the normal equations of
    /// all errors together.
    [[nodiscard]] double FreeRows(const Eigen::MatrixXd& covariance) const;
    /// Root mean square of the errors, as much as there would be of them without a fit.
    [[nodiscard]] double ErrorScale(const Eigen::MatrixXd& covariance) const;
};

/// Empty where the matrix is singular or nearly so.
std::optional<Eigen::MatrixXd> InverseOfNormal(const Eigen::MatrixXd& normal);

}  // namespace hitchview::calib
