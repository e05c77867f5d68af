#include <gtest/gtest.h>

#include "algo/unified_options.hpp"
#include "algo/unit_smoother.hpp"
#include "tests/support/shaky_profiles.hpp"

namespace hitchview::algo {
namespace {

using Eigen::Vector3d;

/// No path before, and none moves.
PathSmoother::Window Nothing() {
    PathSmoother::Window window;
    window.early_output = window.earlier_output = window.motion = Vector3d::Zero();
    window.ahead.fill(Vector3d::Zero());
    return window;
}

/// Paths as rows of frames; each step is given what UnifiedVertexMotion gives.
Profiles SmoothCausally(UnitSmoother sut, const Profiles& T, int lookahead_frames = 0) {
    Profiles x = T;
    const auto apart = [](const auto& a, const auto& b) { return Vector3d((a - b).transpose()); };
    for (Eigen::Index t = 0; t < T.rows(); ++t) {
        PathSmoother::Window window = Nothing();
        if (t > 0) window.early_output = apart(x.row(t - 1), T.row(t));
        if (t > 1) window.earlier_output = apart(x.row(t - 2), T.row(t));
        if (t > 0) window.motion = apart(T.row(t), T.row(t - 1));
        for (int j = 1; j <= lookahead_frames; ++j) {
            const Eigen::Index ahead = std::min(T.rows() - 1, t + j);
            window.ahead[static_cast<std::size_t>(j - 1)] = apart(T.row(ahead), T.row(t));
        }
        x.row(t) += sut.Next(window).transpose();
    }
    return x;
}

Profiles ShakyPaths(int frames) {
    Profiles T(frames, 3);
    for (int k = 0; k < 3; ++k)
        T.col(k) = tests::ShakyPath(frames, static_cast<std::uint64_t>(31 + k));
    return T;
}

TEST(WalledPaperWeightsTest, FarFromItsWallsItIsThePapersWeightsAlone) {
    const Profiles T = ShakyPaths(200);
    const Profiles x = SmoothCausally(UnitSmoother(WalledPaperWeights({})), T);
    const PaperWeightsSmoother oracle({}, 0);
    OutputHistory history(10);
    history.Push(Vector3d::Zero());  // before its first frame, a path stood still
    for (Eigen::Index t = 0; t < T.rows(); ++t) {
        if (t > 0) history.Move((T.row(t) - T.row(t - 1)).transpose());
        const Vector3d offset = oracle.Next({history.outputs(), {}});
        history.Push(offset);
        EXPECT_LT((x.row(t) - T.row(t) - offset.transpose()).norm(), 1e-9) << t;
    }
}

TEST(WalledPaperWeightsTest, APanIsFollowedWithinTheWall) {
    Profiles T(120, 3);
    for (int t = 0; t < 120; ++t) T.row(t).setConstant(5.0 * t);
    const Vector3d wall{20, 12, 30};
    const Profiles x = SmoothCausally(UnitSmoother(WalledPaperWeights({.wall = wall})), T);
    const Vector3d lag = (T.row(119) - x.row(119)).transpose();
    EXPECT_LT((lag - wall).norm(), 1e-9) << "65 px without walls";
}

TEST(WalledPaperWeightsTest, TheTurnTakesItsShareOfTheShiftsRoom) {
    Profiles T(120, 3);
    for (int t = 0; t < 120; ++t) T.row(t) << 5.0 * t, 5.0 * t, 0.1 * t;
    const PathSmootherOptions options{.wall = {20, 12, 0.05}, .turn_takes_px = {100, 300}};
    const Profiles x = SmoothCausally(UnitSmoother(WalledPaperWeights(options)), T);
    EXPECT_NEAR(T(119, 2) - x(119, 2), 0.05, 1e-9);
    EXPECT_NEAR(T(119, 0) - x(119, 0), 20 - 100 * 0.05, 1e-9);
    EXPECT_NEAR(T(119, 1) - x(119, 1), 0, 1e-9) << "nothing is left of 12 px";
}

TEST(WalledPaperWeightsTest, AfterAResetItKnowsNothing) {
    const Profiles T = ShakyPaths(60);
    UnitSmoother used(WalledPaperWeights({}));
    PathSmoother::Window elsewhere = Nothing();
    elsewhere.early_output = {9, 9, 9};
    for (int t = 0; t < 30; ++t) used.Next(elsewhere);
    used.Reset();
    const Profiles x = SmoothCausally(used, T);
    EXPECT_EQ(x, SmoothCausally(UnitSmoother(WalledPaperWeights({})), T));
}

TEST(UnitSmootherTest, TheOptionsChooseBetweenTwoThatSmoothDifferently) {
    const Projection plane = Projection::Plane(640, 360);
    const Profiles T = ShakyPaths(150);
    const auto smoothed = [&](Smoother smoother) {
        UnifiedVertexMotionOptions options;
        options.smoother = smoother;
        options.lookahead_frames = 2;
        return SmoothCausally(MakeUnitSmoother(plane, plane, options), T, 2);
    };
    const Profiles paper = smoothed(Smoother::kPaperWeights);
    const Profiles horizon = smoothed(Smoother::kRecedingHorizon);
    EXPECT_GT((paper - horizon).cwiseAbs().maxCoeff(), 0.5);
    EXPECT_LT(tests::Jitter(horizon.col(0)), 0.7 * tests::Jitter(paper.col(0)));
    EXPECT_LT(tests::Jitter(paper.col(0)), 0.2 * tests::Jitter(T.col(0)));
}

}  // namespace
}  // namespace hitchview::algo
