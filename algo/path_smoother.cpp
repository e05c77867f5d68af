#include "algo/path_smoother.hpp"

#include <algorithm>
#include <cmath>

#include "algo/second_difference_system.hpp"

namespace hitchview::algo {
namespace {

using Eigen::Vector3d;

/// Share of the demand for pull that is given up per frame once the offset leaves the wall.
constexpr double kRelease = 0.06;
/// The set of exceeded walls settles after two or three solves.
constexpr int kMaxSolves = 8;
constexpr int kTurn = 2;

}  // namespace

PathSmoother::PathSmoother(const PathSmootherOptions& options)
    : options_(options),
      frames_(1 + std::clamp(options.lookahead_frames, 0, kMaxLookahead) +
              std::clamp(options.horizon_frames, 1, PathSmootherOptions::kMaxHorizon)) {}

Vector3d PathSmoother::Next(const Window& window) {
    UpdateVelocity(window);
    Vector3d offset;
    for (const int component : {kTurn, 0, 1}) {  // the turn takes its share of the shift's room
        const double early = window.early_output(component);
        GuessPath(window, component);
        SetWall(component);
        Plan(early, window.earlier_output(component), UpdatePull(early, component));
        offset(component) = std::clamp(output_[0], -wall_[0], wall_[0]);
        if (component != kTurn) continue;
        for (std::size_t t = 0; t < turn_.size(); ++t) {
            turn_[t] = std::min(std::abs(output_[t] - path_[t]), wall_[t]);
        }
    }
    return offset;
}

void PathSmoother::UpdateVelocity(const Window& window) {
    Vector3d newest = window.motion;
    if (options_.lookahead_frames > 0) {
        const auto last = static_cast<std::size_t>(options_.lookahead_frames - 1);
        newest = window.ahead[last];
        if (last > 0) newest -= window.ahead[last - 1];
    }
    velocity_ += options_.velocity_smoothing * (newest - velocity_);
}

double PathSmoother::UpdatePull(double early_offset, int component) {
    const double nearness = std::abs(early_offset) / options_.wall(component);
    const double wanted =
        std::clamp((nearness - options_.free_share) / (1 - options_.free_share), 0.0, 1.0);
    double& demand = demand_(component);
    demand = std::max(wanted, demand * (1 - kRelease));
    return options_.weakest_pull *
           std::pow(options_.strongest_pull / options_.weakest_pull, demand);
}

void PathSmoother::GuessPath(const Window& window, int component) {
    double velocity = velocity_(component);
    path_[0] = 0;
    for (int t = 1; t < frames_; ++t) {
        const auto i = static_cast<std::size_t>(t);
        if (t <= options_.lookahead_frames) {
            path_[i] = window.ahead[i - 1](component);
        } else {
            velocity *= options_.guess_damping;
            path_[i] = path_[i - 1] + velocity;
        }
    }
}

void PathSmoother::SetWall(int component) {
    for (int t = 0; t < frames_; ++t) {
        const auto i = static_cast<std::size_t>(t);
        double wall = options_.wall(component);
        if (component != kTurn) {
            wall = std::max(0.0, wall - options_.turn_takes_px(component) * turn_[i]);
        }
        wall_[i] = wall * (t <= options_.lookahead_frames ? 1 : options_.guessed_wall_share);
    }
}

void PathSmoother::Plan(double early, double earlier, double pull) {
    const auto n = static_cast<std::size_t>(frames_);
    SecondDifferenceSystem<kMaxPlan> system;
    Planned weight;
    Planned target;
    exceeded_.fill(0);
    for (int solve = 0; solve < kMaxSolves; ++solve) {
        for (std::size_t t = 0; t < n; ++t) {
            const double stiffness = exceeded_[t] != 0 ? options_.wall_stiffness : 0;
            weight[t] = pull + stiffness;
            target[t] = path_[t] + stiffness * exceeded_[t] * wall_[t] / weight[t];
        }
        system.Solve(early, earlier, {weight.data(), n}, {target.data(), n}, {output_.data(), n});
        if (!FindExceeded()) return;
    }
}

/// True if the walls that the plan exceeds have changed.
bool PathSmoother::FindExceeded() {
    if (options_.wall_stiffness <= 0) return false;
    bool changed = false;
    for (std::size_t t = 0; t < static_cast<std::size_t>(frames_); ++t) {
        const double offset = output_[t] - path_[t];
        const int side = offset > wall_[t] ? 1 : offset < -wall_[t] ? -1 : 0;
        changed = changed || side != exceeded_[t];
        exceeded_[t] = side;
    }
    return changed;
}

void PathSmoother::Reset() {
    velocity_.setZero();
    demand_.setZero();
}

}  // namespace hitchview::algo
