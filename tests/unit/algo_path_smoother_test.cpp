#include <gtest/gtest.h>

#include <Eigen/QR>
#include <cmath>
#include <numbers>
#include <opencv2/core.hpp>
#include <vector>

#include "algo/path_smoother.hpp"

namespace hitchview::algo {
namespace {

using Eigen::Vector3d;
using Path = std::vector<double>;

constexpr double kFramesPerSecond = 30;

PathSmoother::Window WindowAt(const Path& path, const Path& smooth, int t, int lookahead) {
    const auto at = [](const Path& p, int i) {
        return p[static_cast<std::size_t>(std::clamp(i, 0, static_cast<int>(p.size()) - 1))];
    };
    // All components follow the same path, the second one mirrored and the third one at half size.
    const Vector3d shape{1, -1, 0.5};
    PathSmoother::Window window;
    const double now = at(path, t);
    window.early_output = (t >= 1 ? at(smooth, t - 1) - now : 0) * shape;
    window.earlier_output = (t >= 2   ? at(smooth, t - 2) - now
                             : t == 1 ? at(smooth, 0) - now
                                      : 0) *
                            shape;
    window.motion = (now - at(path, t - 1)) * shape;
    window.ahead.fill(Vector3d::Zero());
    for (int j = 1; j <= lookahead; ++j) {
        window.ahead[static_cast<std::size_t>(j - 1)] = (at(path, t + j) - now) * shape;
    }
    return window;
}

/// The smoothed path; with lookahead the path is taken to stand still after its end.
Path Smooth(PathSmoother& smoother, const Path& path, int lookahead = 0) {
    Path smooth;
    for (int t = 0; t < static_cast<int>(path.size()); ++t) {
        const Vector3d offset = smoother.Next(WindowAt(path, smooth, t, lookahead));
        EXPECT_NEAR(offset.y(), -offset.x(), 1e-9);
        EXPECT_NEAR(offset.z(), offset.x() / 2, 1e-9);
        smooth.push_back(path[static_cast<std::size_t>(t)] + offset.x());
    }
    return smooth;
}

Path Smooth(const PathSmootherOptions& options, const Path& path) {
    PathSmoother smoother(options);
    return Smooth(smoother, path, options.lookahead_frames);
}

template <typename Function>
Path PathOf(int frames, Function&& function) {
    Path path;
    for (int t = 0; t < frames; ++t) path.push_back(function(t / kFramesPerSecond));
    return path;
}

/// A pan with a shake on top and a fixed random walk, px.
Path ShakenPan(int frames) {
    cv::RNG random(4);
    double walk = 0;
    return PathOf(frames, [&](double s) {
        walk += random.gaussian(0.6);
        return 40 * s + walk + 3 * std::sin(2 * std::numbers::pi * 2.3 * s) + random.gaussian(0.5);
    });
}

/// Energy of the second differences, without the first frames.
double Roughness(const Path& path, std::size_t from = 60) {
    double sum = 0;
    for (std::size_t t = from; t < path.size(); ++t) {
        sum += std::pow(path[t] - 2 * path[t - 1] + path[t - 2], 2);
    }
    return sum;
}

double LargestOffset(const Path& path, const Path& smooth) {
    double largest = 0;
    for (std::size_t t = 0; t < path.size(); ++t)
        largest = std::max(largest, std::abs(smooth[t] - path[t]));
    return largest;
}

TEST(PathSmootherTest, APathThatStandsStillStays) {
    const Path path(100, 17.0);
    EXPECT_LT(LargestOffset(path, Smooth({}, path)), 1e-12);
    EXPECT_LT(LargestOffset(path, Smooth({.lookahead_frames = 5}, path)), 1e-12);
}

/// First output of the stated objective, solved as one dense least squares problem.
double DenseSolution(const PathSmoother::Window& window, const PathSmootherOptions& options,
                     double pull, double velocity) {
    const int n = options.lookahead_frames + 1 + options.horizon_frames;
    std::vector<double> target{0.0};
    for (int j = 0; j < options.lookahead_frames; ++j) {
        target.push_back(window.ahead[static_cast<std::size_t>(j)].x());
    }
    while (static_cast<int>(target.size()) < n) {
        velocity *= options.guess_damping;
        target.push_back(target.back() + velocity);
    }
    Eigen::MatrixXd rows = Eigen::MatrixXd::Zero(2 * n, n);
    Eigen::VectorXd right = Eigen::VectorXd::Zero(2 * n);
    for (int t = 0; t < n; ++t) {
        const std::array<double, 3> kernel{1, -2, 1};
        for (int k = 0; k < 3; ++k) {
            const double factor = kernel[static_cast<std::size_t>(k)];
            if (t - k >= 0) rows(t, t - k) += factor;
            if (t - k == -1) right(t) -= factor * window.early_output.x();
            if (t - k == -2) right(t) -= factor * window.earlier_output.x();
        }
        rows(n + t, t) = std::sqrt(pull);
        right(n + t) = std::sqrt(pull) * target[static_cast<std::size_t>(t)];
    }
    return rows.colPivHouseholderQr().solve(right)(0);
}

class TapsTest : public testing::TestWithParam<std::tuple<int, double>> {};

TEST_P(TapsTest, AreTheSolutionOfTheStatedObjective) {
    const auto [lookahead, pull] = GetParam();
    const PathSmootherOptions options{
        .lookahead_frames = lookahead, .weakest_pull = pull, .strongest_pull = pull};
    const auto last = static_cast<std::size_t>(std::max(0, lookahead - 1));
    PathSmoother smoother(options);
    cv::RNG random(9);
    double velocity = 0;
    for (int i = 0; i < 30; ++i) {
        PathSmoother::Window window;
        const auto any = [&] { return Vector3d(random.gaussian(10), 0, 0); };
        window.early_output = any();
        window.earlier_output = any();
        window.motion = any();
        for (Vector3d& ahead : window.ahead) ahead = any();
        const double newest = lookahead == 0 ? window.motion.x()
                              : lookahead == 1
                                  ? window.ahead[0].x()
                                  : window.ahead[last].x() - window.ahead[last - 1].x();
        velocity += options.velocity_smoothing * (newest - velocity);
        EXPECT_NEAR(smoother.Next(window).x(), DenseSolution(window, options, pull, velocity),
                    1e-6);
    }
}

INSTANTIATE_TEST_SUITE_P(LookaheadAndPull, TapsTest,
                         testing::Combine(testing::Values(0, 1, 2, 5, kMaxLookahead),
                                          testing::Values(1e-5, 1e-2, 1.0)));

TEST(PathSmootherTest, ASteadyPanLeavesNoLagWhenTheGuessIsThatItGoesOn) {
    const Path path = PathOf(900, [](double s) { return 150 * s; });  // 5 px per frame
    for (const int lookahead : {0, 3, kMaxLookahead}) {
        const Path smooth = Smooth({.lookahead_frames = lookahead, .guess_damping = 1}, path);
        EXPECT_NEAR(smooth[850], path[850], 0.01) << lookahead;
    }
}

TEST(PathSmootherTest, ADampedGuessCostsASteadyPanAFewFramesOfLagAndLessWithLookahead) {
    constexpr double kPxPerFrame = 5;
    const Path path = PathOf(1800, [](double s) { return kPxPerFrame * kFramesPerSecond * s; });
    double last = 10;
    for (const int lookahead : {0, 3, kMaxLookahead}) {
        const Path smooth = Smooth({.lookahead_frames = lookahead}, path);
        const double lag_frames = (path[1700] - smooth[1700]) / kPxPerFrame;
        EXPECT_GE(lag_frames, 0) << lookahead;
        EXPECT_LT(lag_frames, last) << lookahead;
        EXPECT_NEAR((path[1200] - smooth[1200]) / kPxPerFrame, lag_frames, 0.01) << "it is steady";
        last = lag_frames;
    }
}

TEST(PathSmootherTest, ShakeAboveOneHertzIsReducedByMoreThanFourFifths) {
    for (const double hertz : {1.0, 1.5, 2.5, 5.0, 10.0}) {
        const Path path =
            PathOf(600, [&](double s) { return 10 * std::sin(2 * std::numbers::pi * hertz * s); });
        const Path smooth = Smooth({}, path);
        double in = 0;
        double out = 0;
        for (std::size_t t = 300; t < 600; ++t) {
            in += path[t] * path[t];
            out += smooth[t] * smooth[t];
        }
        EXPECT_LT(std::sqrt(out / in), 0.2) << hertz << " Hz";
    }
}

TEST(PathSmootherTest, TheOffsetNeverLeavesTheWall) {
    const PathSmootherOptions options{.wall = {12, 12, 6}};
    cv::RNG random(8);
    double at = 0;
    const Path path = PathOf(900, [&](double s) {
        at += random.gaussian(4) + (s > 10 ? 25 : 0);  // from 10 s on, a violent pan
        return at;
    });
    const Path smooth = Smooth(options, path);
    EXPECT_LE(LargestOffset(path, smooth), 12 + 1e-9);
    EXPECT_GT(LargestOffset(path, smooth), 6) << "a wall that is never near tests nothing";
}

TEST(PathSmootherTest, APlanThatKnowsItsWallIsSmootherThanACutAtIt) {
    const Path path = ShakenPan(900);
    PathSmootherOptions options{.lookahead_frames = kMaxLookahead,
                                .weakest_pull = 1e-4,
                                .strongest_pull = 1e-4,
                                .wall = {4, 4, 2}};
    const Path cut = Smooth(options, path);
    options.wall_stiffness = 4;
    const Path planned = Smooth(options, path);
    EXPECT_LE(LargestOffset(path, planned), 4 + 1e-9);
    EXPECT_GT(LargestOffset(path, cut), 3.9) << "a wall that is never reached tests nothing";
    EXPECT_LT(Roughness(planned), 0.5 * Roughness(cut));
}

TEST(PathSmootherTest, ATurnTakesItsShareOfTheRoomToShift) {
    const PathSmootherOptions options{.wall = {10, 10, 0.1}, .turn_takes_px = {60, 20}};
    PathSmoother smoother(options);
    PathSmoother::Window window;
    window.ahead.fill(Vector3d::Zero());
    window.motion.setZero();
    window.early_output = window.earlier_output = {50, 50, 0.05};
    const Vector3d offset = smoother.Next(window);
    EXPECT_GT(offset.z(), 0.04);
    EXPECT_NEAR(offset.x(), 10 - 60 * offset.z(), 1e-9);
    EXPECT_NEAR(offset.y(), 10 - 20 * offset.z(), 1e-9);
}

TEST(PathSmootherTest, APathBackFromTheWallIsSmoothAgainAfterAWhile) {
    const PathSmootherOptions options{.wall = {12, 12, 6}};
    Path path = PathOf(900, [](double s) {
        return s > 2 && s < 4 ? 200 * (s - 2) : s < 4 ? 0 : 400;
    });
    for (std::size_t t = 0; t < path.size(); ++t)
        path[t] += 2 * std::sin(1.2 * static_cast<double>(t));
    const Path smooth = Smooth(options, path);
    EXPECT_LT(Roughness(smooth, 600), 0.02 * Roughness(path, 600));
}

TEST(PathSmootherTest, MoreLookaheadNeverMakesAShakenPanRougher) {
    const Path path = ShakenPan(900);
    double last = Roughness(path);
    for (const int lookahead : {0, 1, 2, 3, 5, 8, kMaxLookahead}) {
        const double roughness =
            Roughness(Smooth({.lookahead_frames = lookahead, .wall = {30, 30, 15}}, path));
        EXPECT_LE(roughness, last) << lookahead;
        last = roughness;
    }
}

TEST(PathSmootherTest, AfterResetThePastHasNoInfluence) {
    const PathSmootherOptions options{.wall = {12, 12, 6}};
    PathSmoother used(options);
    Smooth(used, PathOf(200, [](double s) { return 500 * s; }));
    used.Reset();
    PathSmoother fresh(options);
    const Path path = ShakenPan(100);
    EXPECT_EQ(Smooth(used, path), Smooth(fresh, path));
}

TEST(PathSmootherTest, WhereThePathLiesDoesNotMatter) {
    const Path path = ShakenPan(300);
    Path far = path;
    for (double& x : far) x += 1e6;
    const Path smooth = Smooth({}, path);
    const Path smooth_far = Smooth({}, far);
    for (std::size_t t = 0; t < path.size(); ++t) EXPECT_NEAR(smooth_far[t] - smooth[t], 1e6, 1e-4);
}

}  // namespace
}  // namespace hitchview::algo
