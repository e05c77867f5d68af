#include "algo/path_smoother.hpp"

#include <Eigen/Dense>
#include <algorithm>
#include <cmath>

namespace hitchview::algo {
namespace {

/// Share of the demand for pull that is given up per frame once the offset leaves the wall.
constexpr double kRelease = 0.05;

}  // namespace

PathSmoother::PathSmoother(const PathSmootherOptions& options) : options_(options) {
    for (int i = 0; i < kPulls; ++i) {
        const double share = static_cast<double>(i) / (kPulls - 1);
        taps_[static_cast<std::size_t>(i)] = Solve(
            options.weakest_pull * std::pow(options.strongest_pull / options.weakest_pull, share));
    }
}

PathSmoother::Taps PathSmoother::Solve(double pull) const {
    const int known = options_.lookahead_frames + 1;
    const int n = known + options_.horizon_frames;
    // Rows of `second` are the second differences; x_{-1} and x_{-2} go to the right side.
    Eigen::MatrixXd second = Eigen::MatrixXd::Zero(n, n);
    Eigen::MatrixXd fixed = Eigen::MatrixXd::Zero(n, 2);  // factors of x_{-1}, x_{-2}
    for (int t = 0; t < n; ++t) {
        second(t, t) = 1;
        (t >= 1 ? second(t, t - 1) : fixed(t, 0)) += -2;
        if (t >= 2) {
            second(t, t - 2) = 1;
        } else {
            fixed(t, t == 1 ? 0 : 1) += 1;
        }
    }
    const Eigen::MatrixXd normal =
        second.transpose() * second + pull * Eigen::MatrixXd::Identity(n, n);
    const Eigen::RowVectorXd row = normal.ldlt().solve(Eigen::VectorXd::Unit(n, 0)).transpose();
    const Eigen::RowVectorXd outputs = -row * second.transpose() * fixed;

    Taps taps{outputs(0), outputs(1), 0, {}};
    double travelled = 0;
    double velocity = 1;
    double guessed = 0;
    for (int t = 1; t < n; ++t) {
        if (t < known - 1) {
            taps.ahead[static_cast<std::size_t>(t - 1)] = pull * row(t);
            continue;
        }
        guessed += t == known - 1 ? 0 : pull * row(t);
        if (t >= known) {
            velocity *= options_.guess_damping;
            travelled += velocity;
            taps.velocity += pull * row(t) * travelled;
        }
    }
    // The guess starts at the last frame seen, so that frame carries its own weight and theirs.
    if (known > 1) {
        taps.ahead[static_cast<std::size_t>(known - 2)] = pull * row(known - 1) + guessed;
    }
    return taps;
}

double PathSmoother::Apply(const Taps& taps, const Window& window, int component) const {
    double offset = taps.early * window.early_output(component) +
                    taps.earlier * window.earlier_output(component) +
                    taps.velocity * velocity_(component);
    for (int j = 0; j < options_.lookahead_frames; ++j) {
        offset += taps.ahead[static_cast<std::size_t>(j)] *
                  window.ahead[static_cast<std::size_t>(j)](component);
    }
    return offset;
}

Eigen::Vector3d PathSmoother::Next(const Window& window) {
    velocity_ += options_.velocity_smoothing * (window.motion - velocity_);
    Eigen::Vector3d offset;
    for (int c = 0; c < 3; ++c) {
        const double wall = options_.wall(c);
        const double nearness = std::abs(window.early_output(c)) / wall;
        const double wanted =
            std::clamp((nearness - options_.free_share) / (1 - options_.free_share), 0.0, 1.0);
        demand_(c) = std::max(wanted, demand_(c) * (1 - kRelease));
        const double at = demand_(c) * (kPulls - 1);
        const auto i = std::min<std::size_t>(static_cast<std::size_t>(at), kPulls - 2);
        const double share = at - static_cast<double>(i);
        const double free =
            (1 - share) * Apply(taps_[i], window, c) + share * Apply(taps_[i + 1], window, c);
        offset(c) = std::clamp(free, -wall, wall);
    }
    return offset;
}

void PathSmoother::Reset() {
    velocity_.setZero();
    demand_.setZero();
}

}  // namespace hitchview::algo
