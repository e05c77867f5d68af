#include <gtest/gtest.h>

#include <numbers>

#include "algo/profile_smoothing.hpp"
#include "tests/support/shaky_profiles.hpp"

namespace hitchview::algo {
namespace {

using Eigen::Index;
using Eigen::VectorXd;
using tests::ShakyPath;

constexpr ProfileSmoothingOptions kPaper{};

VectorXd Smooth(const VectorXd& T, const ProfileSmoothingOptions& options = kPaper) {
    return SmoothProfiles(T, options);
}

TEST(ProfileSmoothingTest, TheWeightsAreThePapers) {
    EXPECT_NEAR(TemporalWeight(1, 10), 0.914, 1e-3);
    EXPECT_NEAR(TemporalWeight(-2, 10), 0.698, 1e-3);
    EXPECT_NEAR(TemporalWeight(3, 10), 0.445, 1e-3);
    EXPECT_NEAR(TemporalWeight(10, 10), 1.234e-4, 1e-6);
    EXPECT_EQ(TemporalWeight(11, 10), 0);
    double one_sided = 0;
    for (int d = 1; d <= 10; ++d) one_sided += TemporalWeight(d, 10);
    EXPECT_NEAR(one_sided, 2.4541, 1e-4);
}

TEST(ProfileSmoothingTest, TheResultMinimisesThePapersEnergy) {
    const VectorXd T = ShakyPath(60, 1);
    const VectorXd x = Smooth(T);
    const double least = StabilizationEnergy(x, T, kPaper);
    cv::RNG random(2);
    for (int trial = 0; trial < 50; ++trial) {
        VectorXd other = x;
        for (double& value : other) value += random.gaussian(trial % 2 == 0 ? 1e-3 : 1.0);
        EXPECT_GT(StabilizationEnergy(other, T, kPaper), least);
    }
}

TEST(ProfileSmoothingTest, AConstantProfileStaysAndTheMeanIsKept) {
    EXPECT_LT((Smooth(VectorXd::Constant(50, 7)) - VectorXd::Constant(50, 7)).norm(), 1e-10);
    const VectorXd T = ShakyPath(90, 3);
    EXPECT_NEAR(Smooth(T).mean(), T.mean(), 1e-10);
}

TEST(ProfileSmoothingTest, TheResultNeverLeavesTheRangeOfItsProfile) {
    for (const std::uint64_t seed : {1U, 2U, 3U}) {
        const VectorXd T = ShakyPath(120, seed);
        const VectorXd x = Smooth(T);
        EXPECT_GE(x.minCoeff(), T.minCoeff());
        EXPECT_LE(x.maxCoeff(), T.maxCoeff());
    }
}

TEST(ProfileSmoothingTest, ATrendIsKeptInTheInteriorAndLagsAtTheEndsAlone) {
    const VectorXd T = VectorXd::LinSpaced(240, 0, 5 * 239);
    const VectorXd error = (Smooth(T) - T) / 5;  // frames
    EXPECT_LT(error.segment(80, 80).cwiseAbs().maxCoeff(), 1e-3);
    EXPECT_NEAR(error(239), -5.4, 0.1) << "the last frame lags";
    EXPECT_NEAR(error(0), 5.4, 0.1);
}

TEST(ProfileSmoothingTest, SinesAreReducedByTheGainOfTheirFrequency) {
    for (const double hertz : {0.2, 0.49, 0.78, 2.0, 6.0}) {
        VectorXd T(600);
        for (Index t = 0; t < T.size(); ++t)
            T(t) = std::sin(2 * std::numbers::pi * hertz / 30 * static_cast<double>(t) + 0.3);
        const VectorXd expected = SmoothingGain(hertz / 30, kPaper) * T;
        EXPECT_LT((Smooth(T) - expected).segment(150, 300).cwiseAbs().maxCoeff(), 2e-3) << hertz;
    }
    EXPECT_NEAR(SmoothingGain(0.49 / 30, kPaper), std::sqrt(0.5), 0.01);
    EXPECT_NEAR(SmoothingGain(0.78 / 30, kPaper), 0.5, 0.01);
}

TEST(ProfileSmoothingTest, OneLambdaForAllFramesIsTheSameMatrix) {
    const VectorXd T = ShakyPath(70, 4);
    const VectorXd lambda = VectorXd::Constant(70, kPaper.lambda);
    const VectorXd x = BandedCholesky(StabilizationMatrix(lambda, kPaper.radius_frames)).Solve(T);
    EXPECT_LT((x - Smooth(T)).cwiseAbs().maxCoeff(), 1e-10);
}

TEST(ProfileSmoothingTest, FramesWithoutLambdaFollowTheirProfileMoreClosely) {
    const VectorXd T = ShakyPath(90, 5);
    VectorXd lambda = VectorXd::Constant(90, 1.2);
    lambda.segment(30, 30).setZero();
    const VectorXd x = BandedCholesky(StabilizationMatrix(lambda, 10)).Solve(T);
    EXPECT_LT((x - T).segment(42, 6).cwiseAbs().maxCoeff(), 1e-3) << "out of reach of the others";
    EXPECT_GT((x - T).head(20).cwiseAbs().maxCoeff(), 0.3);
    EXPECT_NEAR(x.mean(), T.mean(), 1e-10) << "the pairs are weighed alike from both sides";
}

TEST(ProfileSmoothingTest, TrajectoriesAreSumsOfTheirMotions) {
    Profiles motion(3, 2);
    motion << 0, 0, 1, -2, 3, 0.5;
    Profiles expected(3, 2);
    expected << 0, 0, 1, -2, 4, -1.5;
    EXPECT_EQ(AccumulateMotion(motion), expected);
}

}  // namespace
}  // namespace hitchview::algo
