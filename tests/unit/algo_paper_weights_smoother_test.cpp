#include <gtest/gtest.h>

#include <algorithm>
#include <numeric>

#include "algo/paper_weights_smoother.hpp"
#include "tests/support/shaky_profiles.hpp"

namespace hitchview::algo {
namespace {

using Eigen::Vector3d;

constexpr ProfileSmoothingOptions kPaper{};

/// Paths as rows of frames; each step sees what a live run would see.
Profiles SmoothCausally(const Profiles& T, int lookahead_frames) {
    const PaperWeightsSmoother sut(kPaper, lookahead_frames);
    OutputHistory history(kPaper.radius_frames);
    Profiles x = T;
    for (Eigen::Index t = 0; t < T.rows(); ++t) {
        if (t > 0) history.Move((T.row(t) - T.row(t - 1)).transpose());
        std::vector<Vector3d> ahead;
        const Eigen::Index last = std::min<Eigen::Index>(T.rows() - 1, t + lookahead_frames);
        for (Eigen::Index j = t + 1; j <= last; ++j) ahead.emplace_back(T.row(j) - T.row(t));
        const Vector3d offset = sut.Next({history.outputs(), ahead});
        history.Push(offset);
        x.row(t) += offset.transpose();
    }
    return x;
}

Profiles ThreeShakyPaths(int frames) {
    Profiles T(frames, 3);
    for (int k = 0; k < 3; ++k)
        T.col(k) = tests::ShakyPath(frames, static_cast<std::uint64_t>(31 + k));
    return T;
}

TEST(PaperWeightsSmootherTest, SeeingTheWholeRecordingItIsStageOneItself) {
    for (const int frames : {1, 7, 25, 120}) {
        const Profiles T = ThreeShakyPaths(frames);
        const Profiles difference = SmoothCausally(T, frames) - SmoothProfiles(T, kPaper);
        EXPECT_LT(difference.cwiseAbs().maxCoeff(), 1e-3) << frames;
    }
}

TEST(PaperWeightsSmootherTest, TheTapsAreThoseOfTheClosedForms) {
    const PaperWeightsSmoother sut(kPaper, 3);
    const auto now = sut.Taps(10, 0);
    ASSERT_EQ(now.size(), 11U);
    EXPECT_NEAR(now[10], 0.1451, 5e-5);
    const double past[]{0.318, 0.243, 0.155, 0.0825, 0.0367, 0.0136, 0.0042};
    for (std::size_t d = 0; d < std::size(past); ++d) EXPECT_NEAR(now[d], past[d], 5e-4) << d;

    const auto lagged = sut.Taps(10, 3);
    ASSERT_EQ(lagged.size(), 14U);
    const double ahead[]{0.0985, 0.0323, 0.0342, 0.0340};
    for (std::size_t j = 0; j < std::size(ahead); ++j) EXPECT_NEAR(lagged[10 + j], ahead[j], 5e-5);
    const double lagged_past[]{0.326, 0.227, 0.135, 0.068, 0.029, 0.0105};
    for (std::size_t d = 0; d < std::size(lagged_past); ++d)
        EXPECT_NEAR(lagged[d], lagged_past[d], 5e-4) << d;
}

TEST(PaperWeightsSmootherTest, TheTapsOfAnyWindowAddUpToOne) {
    const PaperWeightsSmoother sut(kPaper, 12);
    for (int outputs = 0; outputs <= 10; ++outputs) {
        for (int ahead = 0; ahead <= 12; ++ahead) {
            const auto taps = sut.Taps(outputs, ahead);
            EXPECT_NEAR(std::accumulate(taps.begin(), taps.end(), 0.0), 1, 1e-12);
        }
    }
}

TEST(PaperWeightsSmootherTest, ASteadyPanIsFollowedWithTheKnownLag) {
    const Profiles T = Profiles::Constant(400, 3, 2.0);
    const Profiles pan = AccumulateMotion(T);
    const std::pair<int, double> lags[]{{0, 13.1}, {1, 11.5}, {3, 7.5}, {5, 4.9}, {10, 2.0}};
    for (const auto& [lookahead, lag_frames] : lags) {
        const Profiles x = SmoothCausally(pan, lookahead);
        EXPECT_NEAR((pan(350, 1) - x(350, 1)) / 2.0, lag_frames, 0.06) << lookahead;
    }
}

TEST(PaperWeightsSmootherTest, TheOffsetDiesAwayWhenThePathStandsStill) {
    Profiles motion = Profiles::Zero(250, 3);
    motion.topRows(60).setConstant(4);
    const Profiles T = AccumulateMotion(motion);
    const Profiles offset = SmoothCausally(T, 0) - T;
    EXPECT_LT(offset(59, 0), -40);
    for (int t = 62; t < 250; ++t) EXPECT_LE(std::abs(offset(t, 0)), std::abs(offset(t - 1, 0)));
    EXPECT_LT(std::abs(offset(249, 0)), 0.01);
}

TEST(PaperWeightsSmootherTest, WhereThePathLiesDoesNotMatter) {
    const Profiles T = ThreeShakyPaths(100);
    const Profiles far = (T.array() + 1e7).matrix();
    const Profiles near_offset = SmoothCausally(T, 2) - T;
    const Profiles far_offset = SmoothCausally(far, 2) - far;
    EXPECT_LT((near_offset - far_offset).cwiseAbs().maxCoeff(), 1e-6);
}

TEST(PaperWeightsSmootherTest, ShakeIsReducedByMoreThanFourFifths) {
    const Profiles T = ThreeShakyPaths(300);
    for (const int lookahead : {0, 3, 10}) {
        const Profiles x = SmoothCausally(T, lookahead);
        for (int k = 0; k < 3; ++k)
            EXPECT_LT(tests::Jitter(x.col(k)), 0.2 * tests::Jitter(T.col(k))) << lookahead;
    }
}

}  // namespace
}  // namespace hitchview::algo
