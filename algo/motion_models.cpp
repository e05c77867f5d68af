#include "algo/motion_models.hpp"

#include <Eigen/Dense>
#include <cmath>

namespace hitchview::algo {
namespace {

using Eigen::Matrix3d;
using Eigen::Vector2d;
using Eigen::Vector3d;

struct WeightedCentres {
    double weight = 0;
    Vector2d from = Vector2d::Zero();
    Vector2d to = Vector2d::Zero();
};

WeightedCentres Centres(std::span<const RayPair> pairs, std::span<const double> weights) {
    WeightedCentres c;
    for (std::size_t i = 0; i < pairs.size(); ++i) {
        c.weight += weights[i];
        c.from += weights[i] * pairs[i].from.head<2>();
        c.to += weights[i] * pairs[i].to.head<2>();
    }
    c.from /= c.weight;
    c.to /= c.weight;
    return c;
}

/// Moves the weighted centre to 0 and the mean distance from it to sqrt(2).
Matrix3d Normaliser(const Vector2d& centre, double mean_square) {
    const double scale = std::sqrt(2 / mean_square);
    Matrix3d n = Matrix3d::Identity();
    n(0, 0) = n(1, 1) = scale;
    n.topRightCorner<2, 1>() = -scale * centre;
    return n;
}

double PlaneSquaredResidual(const Matrix3d& m, const RayPair& pair) {
    const Vector3d q = m * pair.from;
    if (std::abs(q.z()) < 1e-12) return 1e12;
    return (q.head<2>() / q.z() - pair.to.head<2>()).squaredNorm();
}

}  // namespace

std::optional<Matrix3d> SimilarityModel::Fit(std::span<const RayPair> pairs,
                                             std::span<const double> weights) {
    const WeightedCentres c = Centres(pairs, weights);
    double square = 0;
    double dot = 0;
    double cross = 0;
    for (std::size_t i = 0; i < pairs.size(); ++i) {
        const Vector2d p = pairs[i].from.head<2>() - c.from;
        const Vector2d q = pairs[i].to.head<2>() - c.to;
        square += weights[i] * p.squaredNorm();
        dot += weights[i] * p.dot(q);
        cross += weights[i] * (p.x() * q.y() - p.y() * q.x());
    }
    if (!(square > 1e-9 * c.weight)) return std::nullopt;
    Matrix3d m = Matrix3d::Identity();
    m.topLeftCorner<2, 2>() << dot / square, -cross / square, cross / square, dot / square;
    m.topRightCorner<2, 1>() = c.to - m.topLeftCorner<2, 2>() * c.from;
    return m;
}

double SimilarityModel::SquaredResidual(const Matrix3d& m, const RayPair& pair, double) {
    return PlaneSquaredResidual(m, pair);
}

std::optional<Matrix3d> RotationModel::Fit(std::span<const RayPair> pairs,
                                           std::span<const double> weights) {
    Matrix3d sum = Matrix3d::Zero();
    for (std::size_t i = 0; i < pairs.size(); ++i) {
        sum += weights[i] * pairs[i].to * pairs[i].from.transpose();
    }
    const Eigen::JacobiSVD<Matrix3d> svd(sum, Eigen::ComputeFullU | Eigen::ComputeFullV);
    if (!(svd.singularValues()(1) > 1e-6 * svd.singularValues()(0))) return std::nullopt;
    const double sign = (svd.matrixU() * svd.matrixV().transpose()).determinant() < 0 ? -1 : 1;
    return Matrix3d(svd.matrixU() * Vector3d{1, 1, sign}.asDiagonal() * svd.matrixV().transpose());
}

double RotationModel::SquaredResidual(const Matrix3d& m, const RayPair& pair, double px_per_unit) {
    return px_per_unit * px_per_unit * (m * pair.from - pair.to).squaredNorm();
}

std::optional<Matrix3d> HomographyModel::Fit(std::span<const RayPair> pairs,
                                             std::span<const double> weights) {
    const WeightedCentres c = Centres(pairs, weights);
    double from_square = 0;
    double to_square = 0;
    for (std::size_t i = 0; i < pairs.size(); ++i) {
        from_square += weights[i] * (pairs[i].from.head<2>() - c.from).squaredNorm() / c.weight;
        to_square += weights[i] * (pairs[i].to.head<2>() - c.to).squaredNorm() / c.weight;
    }
    if (!(from_square > 1e-9 && to_square > 1e-9)) return std::nullopt;
    const Matrix3d n_from = Normaliser(c.from, from_square);
    const Matrix3d n_to = Normaliser(c.to, to_square);

    using Row = Eigen::Matrix<double, 8, 1>;
    Eigen::Matrix<double, 8, 8> normal = Eigen::Matrix<double, 8, 8>::Zero();
    Row right = Row::Zero();
    for (std::size_t i = 0; i < pairs.size(); ++i) {
        const Vector2d p = (n_from * pairs[i].from).head<2>();
        const Vector2d q = (n_to * pairs[i].to).head<2>();
        Row a;
        Row b;
        a << p.x(), p.y(), 1, 0, 0, 0, -q.x() * p.x(), -q.x() * p.y();
        b << 0, 0, 0, p.x(), p.y(), 1, -q.y() * p.x(), -q.y() * p.y();
        normal += weights[i] * (a * a.transpose() + b * b.transpose());
        right += weights[i] * (q.x() * a + q.y() * b);
    }
    const Eigen::LDLT<Eigen::Matrix<double, 8, 8>> ldlt(normal);
    if (ldlt.info() != Eigen::Success ||
        ldlt.vectorD().minCoeff() < 1e-9 * ldlt.vectorD().maxCoeff()) {
        return std::nullopt;
    }
    const Row h = ldlt.solve(right);
    Matrix3d normalised;
    normalised << h(0), h(1), h(2), h(3), h(4), h(5), h(6), h(7), 1;
    const Matrix3d m = n_to.inverse() * normalised * n_from;
    if (std::abs(m(2, 2)) < 1e-9) return std::nullopt;
    return Matrix3d(m / m(2, 2));
}

double HomographyModel::SquaredResidual(const Matrix3d& m, const RayPair& pair, double) {
    return PlaneSquaredResidual(m, pair);
}

}  // namespace hitchview::algo
