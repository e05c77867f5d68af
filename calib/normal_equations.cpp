#include "calib/normal_equations.hpp"

#include <Eigen/Eigenvalues>
#include <cmath>

namespace hitchview::calib {
namespace {

struct Evaluation {
    std::vector<double> errors;
    ceres::CRSMatrix jacobian;
};

Evaluation Evaluate(ceres::Problem& problem, const std::vector<ceres::ResidualBlockId>& blocks,
                    const std::vector<double*>& unknowns) {
    ceres::Problem::EvaluateOptions options;
    options.parameter_blocks = unknowns;
    options.residual_blocks = blocks;
    Evaluation evaluation;
    problem.Evaluate(options, nullptr, &evaluation.errors, nullptr, &evaluation.jacobian);
    return evaluation;
}

int Columns(const ceres::Problem& problem, const std::vector<double*>& unknowns) {
    int columns = 0;
    for (double* const block : unknowns) columns += problem.ParameterBlockSize(block);
    return columns;
}

/// Adds one row; only columns below the matrix's size.
void AddRow(const Evaluation& evaluation, std::size_t row, NormalEquations& normal) {
    const ceres::CRSMatrix& jacobian = evaluation.jacobian;
    Eigen::MatrixXd& matrix = normal.matrix;
    for (int i = jacobian.rows[row]; i < jacobian.rows[row + 1]; ++i) {
        const auto at = static_cast<std::size_t>(i);
        if (jacobian.cols[at] >= matrix.rows()) continue;
        normal.gradient[jacobian.cols[at]] += jacobian.values[at] * evaluation.errors[row];
        for (int j = jacobian.rows[row]; j < jacobian.rows[row + 1]; ++j) {
            const auto other = static_cast<std::size_t>(j);
            if (jacobian.cols[other] < matrix.cols())
                matrix(jacobian.cols[at], jacobian.cols[other]) +=
                    jacobian.values[at] * jacobian.values[other];
        }
    }
}

/// An unknown of a few errors only, which is to go.
class LastUnknown {
 public:
    LastUnknown(int columns, int column)
        : column_(column), with_others_(Eigen::VectorXd::Zero(columns)) {}

    void Add(const ceres::CRSMatrix& jacobian, std::size_t row) {
        double own = 0;
        ForEach(jacobian, row, [&](int column, double value) {
            if (column == column_) own = value;
        });
        ForEach(jacobian, row, [&](int column, double value) {
            if (column < with_others_.size()) with_others_[column] += own * value;
        });
        alone_ += own * own;
    }

    void EliminateFrom(Eigen::MatrixXd& matrix) const {
        if (alone_ > 0) matrix -= with_others_ * with_others_.transpose() / alone_;
    }

 private:
    template <typename Use>
    static void ForEach(const ceres::CRSMatrix& jacobian, std::size_t row, const Use& use) {
        for (int i = jacobian.rows[row]; i < jacobian.rows[row + 1]; ++i) {
            const auto at = static_cast<std::size_t>(i);
            use(jacobian.cols[at], jacobian.values[at]);
        }
    }

    int column_;
    Eigen::VectorXd with_others_;
    double alone_ = 0;
};

}  // namespace

NormalEquations NormalEquations::Of(ceres::Problem& problem,
                                    const std::vector<ceres::ResidualBlockId>& blocks,
                                    const std::vector<double*>& unknowns) {
    NormalEquations normal;
    const int columns = Columns(problem, unknowns);
    normal.matrix = Eigen::MatrixXd::Zero(columns, columns);
    normal.gradient = Eigen::VectorXd::Zero(columns);
    if (blocks.empty()) return normal;
    const Evaluation evaluation = Evaluate(problem, blocks, unknowns);
    for (const double error : evaluation.errors) normal.squared_errors += error * error;
    normal.rows = static_cast<double>(evaluation.errors.size());
    for (std::size_t row = 0; row < evaluation.errors.size(); ++row)
        AddRow(evaluation, row, normal);
    return normal;
}

NormalEquations NormalEquations::WithoutLast(ceres::Problem& problem,
                                             const std::vector<ceres::ResidualBlockId>& blocks,
                                             const std::vector<double*>& unknowns) {
    NormalEquations normal;
    const int columns = Columns(problem, unknowns);
    normal.matrix = Eigen::MatrixXd::Zero(columns, columns);
    normal.gradient = Eigen::VectorXd::Zero(columns);
    std::vector<double*> all = unknowns;
    for (const ceres::ResidualBlockId block : blocks) {
        std::vector<double*> own;
        problem.GetParameterBlocksForResidualBlock(block, &own);
        all.push_back(own.back());
    }
    if (blocks.empty()) return normal;
    const Evaluation evaluation = Evaluate(problem, blocks, all);
    const std::size_t each = evaluation.errors.size() / blocks.size();
    for (std::size_t block = 0; block < blocks.size(); ++block) {
        LastUnknown last(columns, columns + static_cast<int>(block));
        for (std::size_t row = block * each; row < (block + 1) * each; ++row) {
            AddRow(evaluation, row, normal);
            last.Add(evaluation.jacobian, row);
        }
        last.EliminateFrom(normal.matrix);
    }
    normal.rows = static_cast<double>(evaluation.errors.size() - blocks.size());
    for (const double error : evaluation.errors) normal.squared_errors += error * error;
    return normal;
}

double NormalEquations::FreeRows(const Eigen::MatrixXd& covariance) const {
    return rows - covariance.cwiseProduct(matrix).sum();
}

double NormalEquations::ErrorScale(const Eigen::MatrixXd& covariance) const {
    const double free = FreeRows(covariance);
    return free > 0 ? std::sqrt(squared_errors / free) : 1.0;
}

std::optional<Eigen::MatrixXd> InverseOfNormal(const Eigen::MatrixXd& normal) {
    constexpr double kLeastShare = 1e-12;
    // Unknowns have different units: compare them by what is known of each alone.
    const Eigen::VectorXd diagonal = normal.diagonal();
    if (!(diagonal.minCoeff() > 0)) return std::nullopt;
    const Eigen::VectorXd scale = diagonal.cwiseSqrt().cwiseInverse();
    const Eigen::SelfAdjointEigenSolver<Eigen::MatrixXd> solver(scale.asDiagonal() * normal *
                                                                scale.asDiagonal());
    const Eigen::VectorXd& values = solver.eigenvalues();
    if (!(values.minCoeff() > kLeastShare * values.maxCoeff())) return std::nullopt;
    const Eigen::MatrixXd& vectors = solver.eigenvectors();
    return Eigen::MatrixXd(scale.asDiagonal() * vectors * values.cwiseInverse().asDiagonal() *
                           vectors.transpose() * scale.asDiagonal());
}

}  // namespace hitchview::calib
