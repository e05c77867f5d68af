#pragma once

#include <cmath>
#include <numbers>
#include <opencv2/core.hpp>

#include "algo/profile_smoothing.hpp"

namespace hitchview::tests {

/// A path of `frames` frames at 30 per second: a wander below 0.3 Hz with shake above 2 Hz on it,
/// about 1.5 px rms; px.
inline Eigen::VectorXd ShakyPath(int frames, std::uint64_t seed) {
    cv::RNG random(seed);
    const double slow_hz = random.uniform(0.05, 0.25);
    const double phase = random.uniform(0.0, 6.0);
    Eigen::VectorXd path(frames);
    double shake = 0;
    double swing = 0;
    for (int t = 0; t < frames; ++t) {
        swing += random.gaussian(1.2) - 0.9 * shake - 0.3 * swing;  // a damped oscillation
        shake += 0.6 * swing;
        path(t) = 12 * std::sin(2 * std::numbers::pi * slow_hz * t / 30 + phase) + shake;
    }
    return path;
}

/// Root mean square of the second difference: what the eye takes for jitter; px.
inline double Jitter(const Eigen::Ref<const Eigen::VectorXd>& path) {
    const Eigen::Index n = path.size() - 2;
    const Eigen::VectorXd bend = path.tail(n) - 2 * path.segment(1, n) + path.head(n);
    return std::sqrt(bend.squaredNorm() / static_cast<double>(n));
}

inline double Rms(const Eigen::Ref<const Eigen::MatrixXd>& values) {
    return std::sqrt(values.squaredNorm() / static_cast<double>(values.size()));
}

}  // namespace hitchview::tests
