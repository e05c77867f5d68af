#include "calib/angle_fit.hpp"

#include <Eigen/Cholesky>
#include <Eigen/LU>
#include <algorithm>
#include <cmath>
#include <map>
#include <numbers>

#include "calib/text.hpp"

namespace hitchview::calib {
namespace {

using Eigen::Matrix2d;
using Eigen::Vector2d;

constexpr double kDegree = std::numbers::pi / 180;
constexpr std::size_t kFewestSeconds = 5;
constexpr double kStraight_rad = 2 * kDegree;
constexpr double kLeastScatter_rad = 1e-4;
/// Of Tukey's biweight, in standard deviations: 95 % as good as least squares on normal errors.
constexpr double kTukey = 4.685;
/// Median distance of a normal variable from 0, in standard deviations.
constexpr double kMedianToSigma = 1.4826;

double Quantile(std::vector<double> values, double share) {
    const auto at = values.begin() +
                    static_cast<std::ptrdiff_t>(share * static_cast<double>(values.size() - 1));
    std::ranges::nth_element(values, at);
    return *at;
}

/// The median difference of each second, at that second's median angle.
std::vector<AnglePair> Seconds(const std::vector<AnglePair>& pairs) {
    struct Second {
        std::vector<double> sensor_rad;
        std::vector<double> image_rad;
    };
    std::map<std::int64_t, Second> seconds;
    for (const AnglePair& pair : pairs) {
        if (!std::isfinite(pair.sensor_rad) || !std::isfinite(pair.image_rad)) continue;
        Second& second = seconds[static_cast<std::int64_t>(std::floor(pair.time_s))];
        second.sensor_rad.push_back(pair.sensor_rad);
        second.image_rad.push_back(pair.image_rad);
    }
    std::vector<AnglePair> medians;
    for (auto& [second, angles] : seconds)
        medians.push_back({static_cast<double>(second), Quantile(angles.sensor_rad, 0.5),
                           Quantile(angles.image_rad, 0.5)});
    return medians;
}

std::vector<double> Residuals(const std::vector<AnglePair>& pairs, const Vector2d& line) {
    std::vector<double> residuals;
    for (const AnglePair& pair : pairs)
        residuals.push_back(pair.image_rad - line[0] * pair.sensor_rad - line[1]);
    return residuals;
}

double Scatter(std::vector<double> residuals) {
    for (double& residual : residuals) residual = std::abs(residual);
    return std::max(kLeastScatter_rad, kMedianToSigma * Quantile(residuals, 0.5));
}

double Weight(double residual_rad, double scatter_rad) {
    const double x = residual_rad / (kTukey * scatter_rad);
    return std::abs(x) < 1 ? (1 - x * x) * (1 - x * x) : 0;
}

/// The line through the median that fits best by its slopes (Theil and Sen): a start that half the
/// pairs cannot spoil.
std::optional<Vector2d> FirstLine(const std::vector<AnglePair>& pairs) {
    constexpr double kLeastStep_rad = 0.5 * kDegree;
    std::vector<double> slopes;
    for (std::size_t i = 0; i < pairs.size(); ++i) {
        for (std::size_t k = 0; k < i; ++k) {
            const double step = pairs[i].sensor_rad - pairs[k].sensor_rad;
            if (std::abs(step) > kLeastStep_rad)
                slopes.push_back((pairs[i].image_rad - pairs[k].image_rad) / step);
        }
    }
    if (slopes.empty()) return std::nullopt;
    const double slope = Quantile(slopes, 0.5);
    return Vector2d(slope, Quantile(Residuals(pairs, {slope, 0}), 0.5));
}

}  // namespace

std::optional<AngleFit> FitAngles(const std::vector<AnglePair>& pairs) {
    const std::vector<AnglePair> seconds = Seconds(pairs);
    if (seconds.size() < kFewestSeconds) return std::nullopt;
    auto line = FirstLine(seconds);
    if (!line) return std::nullopt;
    constexpr int kRounds = 30;
    Matrix2d normal;
    for (int round = 0; round < kRounds; ++round) {
        const std::vector<double> residuals = Residuals(seconds, *line);
        const double scatter_rad = Scatter(residuals);
        normal.setZero();
        Vector2d right = Vector2d::Zero();
        for (std::size_t i = 0; i < seconds.size(); ++i) {
            const Vector2d row(seconds[i].sensor_rad, 1);
            const double weight = Weight(residuals[i], scatter_rad);
            normal += weight * row * row.transpose();
            right += weight * seconds[i].image_rad * row;
        }
        line = normal.ldlt().solve(right);
    }
    AngleFit fit{.factor = (*line)[0], .offset_rad = (*line)[1], .seconds = seconds.size()};
    fit.scatter_rad = Scatter(Residuals(seconds, *line));
    const Matrix2d covariance = fit.scatter_rad * fit.scatter_rad * normal.inverse();
    fit.factor_sigma = std::sqrt(covariance(0, 0));
    fit.offset_sigma_rad = std::sqrt(covariance(1, 1));
    std::vector<double> sensor_rad;
    for (const AnglePair& second : seconds) {
        sensor_rad.push_back(second.sensor_rad);
        if (std::abs(second.image_rad) < kStraight_rad) ++fit.straight_s;
    }
    fit.spread_rad = Quantile(sensor_rad, 0.98) - Quantile(sensor_rad, 0.02);
    return fit;
}

std::vector<std::string> JudgeAngles(const AngleFit& fit) {
    constexpr double kLeastSpread_rad = 15 * kDegree;
    constexpr double kLeastStraight_s = 5;
    constexpr double kMostScatter_rad = 1 * kDegree;
    constexpr double kMostFactorSigma = 0.02;
    constexpr double kMostOffsetSigma_rad = 0.2 * kDegree;
    std::vector<std::string> reasons;
    if (fit.spread_rad < kLeastSpread_rad)
        reasons.push_back(Sentence(
            "the drive has no turn: the sensor's angles spread over %.1f degrees, %.0f are needed "
            "for the factor",
            fit.spread_rad / kDegree, kLeastSpread_rad / kDegree));
    if (fit.straight_s < kLeastStraight_s)
        reasons.push_back(
            Sentence("the drive is straight for %.0f s only, %.0f are needed for the offset",
                     fit.straight_s, kLeastStraight_s));
    if (fit.scatter_rad > kMostScatter_rad)
        reasons.push_back(Sentence(
            "the sensor is %.1f degrees from the line on average, %.0f may be: is it the right "
            "signal?",
            fit.scatter_rad / kDegree, kMostScatter_rad / kDegree));
    if (fit.factor_sigma > kMostFactorSigma || fit.offset_sigma_rad > kMostOffsetSigma_rad)
        reasons.push_back(Sentence(
            "factor and offset are known to %.3f and %.2f degrees only: drive longer, with turns "
            "to both sides and straight pieces",
            fit.factor_sigma, fit.offset_sigma_rad / kDegree));
    return reasons;
}

}  // namespace hitchview::calib
