#include "algo/turn_fit.hpp"

#include <Eigen/Dense>
#include <algorithm>
#include <cmath>

namespace hitchview::algo {
namespace {

using Eigen::Matrix3d;
using Eigen::Vector3d;
using Vector6d = Eigen::Matrix<double, 6, 1>;

/// Ahead and behind, parallax has no direction to speak of.
constexpr double kLeastSine = 1e-3;
constexpr double kLeastLever = 0.2;

double Square(double x) {
    return x * x;
}

/// Geman and McClure.
double Weight(double error, double variance) {
    return Square(1 / (1 + error * error / variance));
}

}  // namespace

/// What the turn leaves of a sight: along where parallax points, and across.
struct TurnFit::Errors {
    Vector3d seen;  ///< expected direction of what is far
    Vector3d along;
    Vector3d across;
    double along_px;
    double across_px;
    double sine;  ///< of the angle between the sight and the translation
    double tau_m;
};

struct TurnFit::Normal {
    Eigen::Matrix<double, 6, 6> matrix = Eigen::Matrix<double, 6, 6>::Zero();
    Vector6d right = Vector6d::Zero();
    int inliers = 0;

    void Add(double weight, double error, const Vector6d& slope) {
        matrix += (weight * slope) * slope.transpose();
        right -= weight * error * slope;
    }
    /// Of an error that does not depend on the translation.
    void AddOfTurn(double weight, double error, const Vector3d& slope) {
        matrix.topLeftCorner<3, 3>() += (weight * slope) * slope.transpose();
        right.head<3>() -= weight * error * slope;
    }
};

TurnFit::TurnFit(const TurnFitOptions& options) : options_(options) {
    Reset();
}

void TurnFit::Reset() {
    constexpr double kUsualSpeed_m = 0.25;  // per frame; its direction is what matters
    usual_t_m_ = {-kUsualSpeed_m, 0, 0};
}

std::optional<Turn> TurnFit::Fit(std::span<const SightMotion> sights, const Matrix3d& R_start) {
    R_ = R_start;
    t_m_ = usual_t_m_;
    Normal normal;
    for (int step = 0; step < options_.steps; ++step) {
        normal = Normal{};
        const double spread_px = Spread(step);
        for (const SightMotion& sight : sights) Add(sight, spread_px, normal);
        AddUsualTranslation(normal);
        Step(normal);
    }
    const Matrix3d covariance = normal.matrix.inverse().topLeftCorner<3, 3>();
    const double deviation_px = options_.px_per_rad * std::sqrt(covariance.diagonal().maxCoeff());
    if (!(deviation_px <= options_.max_deviation_px)) return std::nullopt;
    usual_t_m_ += options_.usual_translation_gain * (t_m_ - usual_t_m_);
    return Turn{R_, normal.inliers, deviation_px};
}

double TurnFit::Spread(int step) const {
    const double part = std::min(1.0, step / (0.6 * options_.steps));
    return options_.first_spread_px * std::pow(options_.spread_px / options_.first_spread_px, part);
}

std::optional<TurnFit::Errors> TurnFit::Measure(const SightMotion& sight) const {
    Errors e;
    e.seen = R_ * sight.early;
    const Vector3d tau = t_m_ + R_ * sight.origin_m - sight.origin_m;
    e.tau_m = tau.norm();
    const Vector3d parallax = tau - e.seen * e.seen.dot(tau);
    e.sine = parallax.norm() / e.tau_m;
    if (!(e.sine > kLeastSine)) return std::nullopt;
    e.along = parallax.normalized();
    e.across = e.seen.cross(e.along);
    const Vector3d error_px = options_.px_per_rad * (sight.late - e.seen);
    e.along_px = error_px.dot(e.along);
    e.across_px = error_px.dot(e.across);
    return e;
}

/// An error along counts less the more parallax there may be; one across, the more there is.
void TurnFit::Add(const SightMotion& sight, double spread_px, Normal& normal) const {
    const auto e = Measure(sight);
    if (!e) return;
    const double noise = Square(spread_px);
    const double across = noise + Square(options_.parallax_turn * e->along_px);
    const double along = noise + Square(options_.px_per_rad * options_.parallax_rad * e->sine);
    const double trust = Weight(e->across_px, across);
    // Another translation turns the parallax that is seen about the sight.
    const double swing_px_per_m = -e->along_px / (e->tau_m * std::max(e->sine, kLeastLever));
    Vector6d slope;
    slope << swing_px_per_m * sight.origin_m.cross(e->across) -
                 options_.px_per_rad * e->seen.cross(e->across),
        swing_px_per_m * e->across;
    normal.Add(trust / across, e->across_px, slope);
    normal.AddOfTurn(trust * Weight(e->along_px, along) / along, e->along_px,
                     -options_.px_per_rad * e->seen.cross(e->along));
    constexpr double kInlier = 0.25;  // weight of an error as large as the deviation
    normal.inliers += trust > kInlier ? 1 : 0;
}

void TurnFit::AddUsualTranslation(Normal& normal) const {
    const double weight = 1 / Square(options_.translation_m);
    normal.matrix.bottomRightCorner<3, 3>().diagonal().array() += weight;
    normal.right.tail<3>() += weight * (usual_t_m_ - t_m_);
}

void TurnFit::Step(const Normal& normal) {
    constexpr double kNothing = 1e-6;  // keeps what no sight tells of where it is
    Eigen::Matrix<double, 6, 6> matrix = normal.matrix;
    matrix.diagonal().array() += kNothing;
    const Vector6d step = matrix.ldlt().solve(normal.right);
    const Vector3d turn = step.head<3>();
    const double angle_rad = turn.norm();
    if (angle_rad > 0) R_ = Eigen::AngleAxisd(angle_rad, turn / angle_rad) * R_;
    t_m_ += step.tail<3>();
}

}  // namespace hitchview::algo
